#include <algorithm>
#include <iterator>

#include "Common/Gui/Fonts.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

constexpr app::Named<app::ColorMode> kColorModeNames[] = {
    {"Dark", app::ColorMode::Dark}, {"Light", app::ColorMode::Light}, {"High contrast", app::ColorMode::HighContrast}};

constexpr app::Named<app::Cost> kCostNames[] = {{"Rays", app::Cost::Rays}, {"Time", app::Cost::Time}};

using app::ViewMode;

struct Mode {
    const char* name;
    ViewMode mode;
    const char* tip;
};
constexpr Mode kModes[] = {
    {"Picture", ViewMode::Picture, "Radiance, with exposure and tone mapping"},
    {"Albedo", ViewMode::Albedo, "Colour of the first surface"},
    {"Normal", ViewMode::Normal, "Direction of the first surface, as red, green, blue"},
    {"Depth", ViewMode::Depth, "Distance to the first surface; near is bright"},
    {"Noise", ViewMode::Noise, "Standard error of each pixel relative to its value, after 16 samples"},
    {"Error", ViewMode::Error, "Difference from the reference relative to it"},
    {"Heat map", ViewMode::Heat, "What each pixel costs, in rays or time, on a logarithmic scale (H)"},
};

bool isAvailable(const Gui& gui, ViewMode mode) {
    if (gui.state.picture.isPreview) return mode == ViewMode::Picture;
    if (mode == ViewMode::Error) return gui.state.referenceFits;
    if (mode == ViewMode::Heat) return gui.state.canShowCost;
    return true;
}

void drawModes(Gui& gui) {
    app::ViewRequest& view = gui.viewRequest;
    row("Show", "What is drawn; errors need a reference, see the comparison (F3)");
    const Mode* current =
        std::find_if(std::begin(kModes), std::end(kModes), [&](const Mode& m) { return m.mode == view.mode; });
    if (ImGui::BeginCombo("##mode", current->name)) {
        for (const Mode& mode : kModes) {
            const auto flags = isAvailable(gui, mode.mode) ? ImGuiSelectableFlags_None : ImGuiSelectableFlags_Disabled;
            if (ImGui::Selectable(mode.name, mode.mode == view.mode, flags)) view.mode = mode.mode;
            tooltip(mode.tip);
        }
        ImGui::EndCombo();
    }
    if (view.mode == ViewMode::Heat && gui.state.canShowTime) {
        combo("Cost", "Rays: camera, scattered and shadow. Time: by the clock of the processor or the device's shaders",
              kCostNames, view.cost);
    }
    if (view.mode == ViewMode::Noise || view.mode == ViewMode::Error || view.mode == ViewMode::Heat) {
        sliderReal("Scale", "Divides the value of the brightest colour, which the legend tells", view.scale, 0.1, 100,
                   "%.2f", true);
    }
    ImGui::Checkbox("Inspect pixels", &view.inspect);
    tooltip("Shows what the pixel under the pointer holds, and the material that it shows");
    ImGui::SameLine();
    if (button(gui.held ? "Unpin (B)" : "Pin for A/B (B)",
               "Keeps what is shown; it stays on the left of a line that the mouse moves, the picture is on the right",
               gui.held || gui.state.picture.image, -1)) {
        gui.hold();
    }
    if (gui.held) {
        const image::Image* shown = gui.state.picture.image.get();
        if (shown != nullptr && (shown->width != gui.held->width || shown->height != gui.held->height)) {
            note("The pinned picture is of another size and cannot be shown beside this one.");
        }
        row("Split", "Share of the pinned picture");
        ImGui::SliderFloat("##split", &gui.split, 0, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp);
    }
}

} // namespace

void drawViewPanel(Gui& gui) {
    app::GuiSettings& settings = gui.settings;
    drawModes(gui);
    double exposure = settings.exposure;
    if (sliderReal("Exposure", "Stops, of what is shown and of PNG files", exposure, -10, 10, "%.2f")) {
        settings.exposure = static_cast<float>(exposure);
    }
    combo("Tone mapping", "How radiance beyond white is shown", app::kTonemaps, settings.tonemap);
    const float space = ImGui::GetStyle().ItemSpacing.x;
    const float width = (ImGui::GetContentRegionAvail().x - space) / 2;
    if (button("Fit", "The whole picture (F); Ctrl + wheel zooms, Ctrl + right drag moves it", true, width))
        gui.view = {};
    ImGui::SameLine(0, space);
    const float pixel = 1 / ImGui::GetIO().DisplayFramebufferScale.x; // in the window's units
    if (button("1:1", "One pixel for each of the window", true, width)) gui.view = {pixel, 0, 0};
    row("Save to", "Folder for F12; empty: your pictures folder, else the home folder");
    inputText("##folder", "pictures folder", settings.saveFolder);
    if (button("Save PNG and EXR", "F12 or Ctrl+S", true, -1)) gui.saveRequested = true;
    ImGui::Spacing();
    combo("Theme", "Colours of the interface", kColorModeNames, settings.colorMode);

    row("Interface scale", "Ctrl + plus, Ctrl + minus");
    static float draft = 0; // while the slider is held: the slider itself would move away from the mouse
    float shown = draft > 0 ? draft : settings.uiScale;
    ImGui::SliderFloat("##scale", &shown, app::kLeastUiScale, app::kMostUiScale, "%.2f", ImGuiSliderFlags_AlwaysClamp);
    if (ImGui::IsItemActive()) {
        draft = shown;
    } else if (draft > 0) {
        settings.uiScale = draft;
        draft = 0;
    }
    row("Font", nullptr);
    const std::string font = settings.font.empty() ? availableFonts().front().name : settings.font;
    if (ImGui::BeginCombo("##font", font.c_str())) {
        for (const FontFile& file : availableFonts()) {
            if (ImGui::Selectable(file.name.c_str(), file.name == font)) settings.font = file.name;
        }
        ImGui::EndCombo();
    }
}

} // namespace rt::gui
