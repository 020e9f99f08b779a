// What the parts of the window's interface share: the session, the settings, and what is shown of both.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "Common/App/Interactive/CameraController.h"
#include "Common/App/Interactive/ErrorList.h"
#include "Common/App/Interactive/GuiSettings.h"
#include "Common/App/Interactive/InteractiveSession.h"
#include "Common/App/Interactive/OtherEngine.h"
#include "Common/App/Interactive/SceneEditor.h"
#include "Common/App/Interactive/SceneExport.h"
#include "Common/App/Interactive/Timeline.h"
#include "Common/Gui/AddedFiles.h"
#include "Common/Gui/FileBrowser.h"
#include "Common/Gui/FrameTimer.h"
#include "Common/Gui/Inspector.h"
#include "Common/Gui/Layout.h"
#include "Common/Gui/MaterialTools.h"
#include "Common/Gui/NoisyPixel.h"
#include "Common/Gui/PanelImage.h"
#include "Common/Gui/PinnedView.h"
#include "Common/Gui/Recovery.h"
#include "Common/Gui/RunBoard.h"
#include "Common/Gui/SamplerView.h"
#include "Common/Gui/SceneEditing.h"
#include "Common/Gui/Thumbnails.h"
#include "Common/Gui/Window.h"
#include "Common/Probe/PathsView.h"
#include "Common/Probe/ProbeView.h"

namespace rt::gui {

// How the picture lies in its part of the window.
struct PictureView {
    float zoom = 0;           // pixels of the window for one of the image; 0: as large as fits
    float panX = 0, panY = 0; // of the image's middle from that of its part, in pixels of the window
};

// What the file browser is open for.
enum class BrowseFor { Scene, Model, Image, Reference, Picture, Export, SaveScene, OpenMaterial, SaveMaterial };

// A part of the window, in its units, and the file that it is to be saved to.
struct SavedPart {
    Rect part;
    std::filesystem::path file;
};

// What is to be raced next.
struct RaceForm {
    std::vector<app::RaceEntrant> entrants; // none: they have not been chosen yet
    std::optional<std::size_t> shown;       // whose picture; none: who leads
    Rect chart;                             // with the headline above it
};

// Members that are not const are for the parts to change; App sends what has changed.
struct Gui {
    app::InteractiveSession& session;
    app::GuiSettings& settings;
    app::CameraController& camera;
    app::RunHistory& history;
    Window& window;
    Thumbnails& thumbnails;       // of the built-in scenes
    Thumbnails& materialPictures; // of the library of materials
    const bool isGpu;
    const std::vector<app::EngineDevice> devices; // of ray-tracing-gpu, those that are suitable
    app::OtherEngine& other;
    const std::string assetsBelow; // as --assets-below says
    app::SceneEditor& editor;
    probe::ProbeView& probe;
    probe::PathsView& paths;
    PanelImage& probeImage;

    app::SessionState state; // of this frame
    app::Timeline timeline;
    SceneEditing editing;
    MaterialTools materials;
    AddedFiles added;
    Recovery recovery;
    SamplerView sampling;
    NoisyPixel noise;
    Rect shownImage; // the whole picture's, in the window's units
    PictureView view;
    app::ViewRequest viewRequest;
    bool showGrid = false, showHistogram = false; // of the picture
    float shownScale = 1;                         // pixels of the window for one of the film
    std::uint32_t previewWidth = 0;               // pixels of a row that suit the window; 0: the picture's own
    PinnedView pinned;                            // for comparison with the picture
    CompareBy compareBy = CompareBy::Split;
    float split = 0.5f;                  // share of the picture's part that shows the pinned one
    bool pickFocus = false;              // the next click in the picture tells what is to be sharp
    std::vector<InspectedRow> inspected; // what the pixel under the pointer holds
    std::uint32_t referenceSpp = 1024;
    std::string referencePath;
    bool onlyThisScene = true;
    RunBoard runs;
    std::vector<app::RunRecord> runsToDelete;   // before the next frame draws any
    std::optional<app::SizeRequest> askedSize;  // of the image, which takes much memory; none
    std::optional<std::size_t> askedViewports;  // likewise, how many
    std::string viewportName;                   // by what it differs from the others; empty: there are no others
    std::optional<std::size_t> wantedViewports; // how many there are to be from the next frame on
    bool stepsFocus = false;                    // likewise the next one is to have the focus
    bool areOthersBusy = false;                 // viewports that have not the focus render or prepare something
    double otherPixels = 0;                     // of the films of viewports that have not the focus
    bool isHeld = false;                        // a control or the camera, by the mouse or by keys
    bool otherIsWanted = false;                 // as soon as this render has ended
    std::uint64_t otherSerial = 0;              // of the picture of the other program that was pinned
    Rect chart;                                 // of the comparison, in the window's units
    std::optional<SavedPart> partToSave;        // of the window, as a file
    RaceForm race;
    UiFigures figures;
    bool showHelp = false;
    std::string revealPanel;  // id of one to bring to where it is seen
    bool focusPanels = false; // the keyboard is to go to the panels
    bool saveRequested = false;
    std::string saveAs;  // a file that was chosen to save to; empty: none
    std::string message; // shown for a while
    double messageTime = -1e9;
    app::ErrorList errors; // shown until they are read
    bool showErrors = false, showScenes = false, showFirstSteps = false;
    std::string sceneSearch;
    FileBrowser browser;
    BrowseFor browseFor = BrowseFor::Scene;
    app::SceneExport exporting;
    float autoExposure = 0; // stops, of the picture

    void openScene(const std::string& source); // once edits of the one before are saved or not wanted
    void close();                              // the window, likewise
    void stepScene(int step);                  // through the built-in ones, round and round
    std::string pictureTitle() const;
    std::optional<app::RunRecord> workInView() const; // of the picture, by this program; none of a preview
    std::string whyNotOther() const;                  // the other program cannot do the same; empty: it can
    void followOther();                               // starts it when it is its turn, and pins what it has rendered
    void cancelOther();
    void hold();                            // the picture, for comparison; or lets it go
    void frameAll();                        // turns no camera, but moves it until all of the scene is in sight
    void exportScene();                     // to a file that is asked for
    void exportTo(const std::string& file); // a scene file or glTF, by its ending
    void followExport();
    void copyPose(); // of the camera, to the clipboard
    void pastePose();
    app::SavedPicture savedPicture() const; // what a file gets: of a film without halves the raw one
    void toggleHeatMap();
    void toggleComparison(); // it and the race have one place
    void toggleRace();
    void saveText(const std::filesystem::path& file, const std::string& text);
    void toggleStatistics();
    std::size_t viewportCount() const { return std::max<std::size_t>(1, settings.viewports.size()); }
    void stepViewports();        // 1, 2, 4, 1
    void setRayTracing(bool on); // where there is a preview to show instead
    void scaleInterface(float change);
    void browse(BrowseFor what);
    void take(const std::filesystem::path& file);            // that was chosen in the browser
    void say(const std::string& text, bool isError = false); // what has been done, or went wrong
    void fail(const std::string& text, app::ErrorSource source);
    // Stops, of what is shown and saved.
    float exposure() const { return settings.exposure + (settings.autoExposure ? autoExposure : 0); }
};

} // namespace rt::gui
