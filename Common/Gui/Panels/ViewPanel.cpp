#include <string>

#include "Common/Gui/Fonts.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

constexpr app::Named<app::ColorMode> kColorModeNames[] = {
    {"Dark", app::ColorMode::Dark}, {"Light", app::ColorMode::Light}, {"High contrast", app::ColorMode::HighContrast}};

constexpr app::Named<app::Cost> kCostNames[] = {{"Rays", app::Cost::Rays}, {"Time", app::Cost::Time}};

using app::ViewMode;

// Of what is shown, which the toolbar chooses.
void drawViewOptions(Gui& gui) {
    app::ViewRequest& view = gui.viewRequest;
    const Disabled rest(gui.state.picture.isPreview);
    {
        const Disabled none(view.mode != ViewMode::Heat || !gui.state.canShowTime);
        combo("Cost",
              "Of the heat map. Rays: camera, scattered and shadow. Time: by the clock of the processor or the "
              "device's shaders",
              kCostNames, view.cost);
    }
    {
        const Disabled none(view.mode != ViewMode::Noise && view.mode != ViewMode::Error &&
                            view.mode != ViewMode::Heat);
        sliderReal("Scale",
                   "Of noise, error and heat map: divides the value of the brightest colour, which the legend "
                   "tells",
                   view.scale, 0.1, 100, "%.2f", true);
    }
    checkbox(
        "Inspect pixels",
        "Shows what the pixel under the pointer holds and the material that it shows; beside a pinned picture what "
        "both hold, and their difference",
        view.inspect);
}

void drawSplit(Gui& gui) {
    const image::Image* shown = gui.state.picture.image.get();
    if (gui.held && shown != nullptr && (shown->width != gui.held->width || shown->height != gui.held->height))
        note("The pinned picture is of another size and cannot be shown beside this one.");
    const Disabled rest(!gui.held);
    row("A/B split", "Share of the pinned picture (B pins it)");
    ImGui::SliderFloat("##split", &gui.split, 0, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp);
}

} // namespace

void drawViewPanel(Gui& gui) {
    app::GuiSettings& settings = gui.settings;
    drawViewOptions(gui);
    drawSplit(gui);
    checkbox("Auto exposure", "The picture's mean luminance becomes middle grey; the exposure below comes on top of it",
             settings.autoExposure);
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
    drawErrorOf(gui, app::ErrorSource::Save);
    if (button("Save PNG and EXR", "F12 or Ctrl+S", true, width)) gui.saveRequested = true;
    ImGui::SameLine(0, space);
    if (button("Save as", "Ctrl+Shift+S", true, width)) gui.browse(BrowseFor::Picture);
    ImGui::Spacing();
    combo("Theme", "Colours of the interface", kColorModeNames, settings.colorMode);

    row("Interface scale", "Ctrl + plus, Ctrl + minus");
    static float draft = 0; // while the slider is held: the slider itself would move away from the mouse
    float shown = draft > 0 ? draft : settings.uiScale;
    ImGui::SliderFloat("##scale", &shown, app::kMinUiScale, app::kMaxUiScale, "%.2f", ImGuiSliderFlags_AlwaysClamp);
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
