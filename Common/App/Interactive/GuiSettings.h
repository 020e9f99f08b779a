// What a window remembers from one time to the next.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "Common/App/Interactive/InteractiveSession.h"
#include "Common/App/Interactive/ObjectTool.h"
#include "Common/App/Options/Options.h"
#include "Common/Render/Names.h"

namespace rt::app {

enum class ColorMode { Dark, Light, HighContrast };
inline constexpr Named<ColorMode> kColorModes[] = {
    {"dark", ColorMode::Dark}, {"light", ColorMode::Light}, {"high-contrast", ColorMode::HighContrast}};

// Of the raw picture and the denoised one.
enum class SaveChoice { Seen, Raw, Denoised, Both };
inline constexpr Named<SaveChoice> kSaveChoices[] = {
    {"seen", SaveChoice::Seen, "What is seen", "The denoised picture while that is shown, else the raw one"},
    {"raw", SaveChoice::Raw, "Raw picture", "The mean of the samples"},
    {"denoised", SaveChoice::Denoised, "Denoised picture", "Filtered once more for the file"},
    {"both", SaveChoice::Both, "Both", "The denoised one beside the raw one, as NAME.denoised.png"}};

// Of the gizmo: what its handles do.
inline constexpr Named<ObjectTool::Kind> kGizmos[] = {
    {"move", ObjectTool::Kind::Move, "Move", "Arrows and squares, by which the pointer moves what is selected"},
    {"turn", ObjectTool::Kind::Turn, "Turn", "Rings, by which the pointer turns what is selected"},
    {"scale", ObjectTool::Kind::Scale, "Scale", "Arms with boxes, by which the pointer scales what is selected"}};

inline constexpr float kMinUiScale = 0.75f;
inline constexpr float kMaxUiScale = 3.0f;
inline constexpr std::size_t kMaxRecent = 10; // files

// What each viewport has of its own.
struct ViewportSettings {
    RenderRequest request;
    EngineChoice engine;
    bool rayTracing = true;             // of ray-tracing-gpu; off: its preview
    bool denoise = true;                // pictures with less noise, while they converge and after
    float exposure = 0;                 // stops
    bool autoExposure = false;          // on top of what suits the picture
    Tonemap tonemap = Tonemap::Neutral; // colours below white stay what they are
    bool operator==(const ViewportSettings&) const = default;
};

inline constexpr std::size_t kViewportCounts[] = {1, 2, 4};
inline constexpr float kMinSplit = 0.1f, kMaxSplit = 0.9f;

// With those of the viewport that has the focus.
struct GuiSettings : ViewportSettings {
    ColorMode colorMode = ColorMode::Dark;
    float uiScale = 1; // on top of the monitor's own
    std::string font;  // its name; empty: the first there is
    int windowX = 0, windowY = 0, windowWidth = 1360, windowHeight = 860;
    bool windowPlaced = false; // the position is known
    bool windowMaximised = false;
    bool showRace = false;   // in place of the comparison
    double raceSeconds = 10; // that each entrant gets
    bool showPanels = true;
    bool showComparison = false;
    bool showStatistics = true;
    // Of the panels at the side: whether each is folded out, by its id; others are as the table of panels says.
    std::map<std::string, bool> openPanels;
    std::vector<ViewportSettings> viewports; // by place; of the one that has the focus this is of no account; none:
                                             // there is one viewport
    std::size_t focusedViewport = 0;         // its place
    float splitX = 0.5f, splitY = 0.5f;      // where viewports meet, as shares of their part of the window
    bool linkCameras = true;                 // of all viewports
    bool reloadScenes = true;                // when their files change
    bool sawFirstSteps = false;              // the hint of the first run
    std::string saveFolder;                  // empty: chosen by the program
    std::vector<std::string> recent;         // scene files that have loaded, the latest first
    std::string scene = "cornell-box-lights";
    SaveChoice saveChoice = SaveChoice::Seen;
    bool showGizmo = true; // over the picture, on what is selected
    ObjectTool::Kind gizmo = ObjectTool::Kind::Move;
    bool localAxes = false; // of the gizmo and of keys: the object's own, not the scene's
    bool operator==(const GuiSettings&) const = default;

    void addRecent(const std::string& file);
    void removeRecent(const std::string& file);
};

// The text of a settings file.
std::string toText(const GuiSettings& settings);
// What is missing or makes no sense keeps its default: a damaged text is no error.
GuiSettings parseGuiSettings(std::string_view text);

// Defaults where there is no file.
GuiSettings loadGuiSettings(const std::filesystem::path& file);
// Replaces the file. Throws RenderError.
void saveGuiSettings(const std::filesystem::path& file, const GuiSettings& settings);

// What the command line, the environment or the configuration file said wins over what was stored.
void override(GuiSettings& settings, const Options& options);

} // namespace rt::app
