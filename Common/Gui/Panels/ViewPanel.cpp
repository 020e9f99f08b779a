
#include "Common/Gui/Panels/ImageSize.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

constexpr app::Named<app::Cost> kCostNames[] = {{"Rays", app::Cost::Rays}, {"Time", app::Cost::Time}};

using app::ViewMode;

// Of what is shown, which the toolbar chooses.
void drawViewOptions(Gui& gui) {
    app::ViewRequest& view = gui.viewRequest;
    const Disabled rest(gui.state.picture.isPreview, "the preview is a picture and nothing else");
    {
        const Disabled none(view.mode != ViewMode::Heat || !gui.state.canShowTime,
                            "the heat map is not shown, or this engine knows no times");
        combo("Cost",
              "Of the heat map. Rays: camera, scattered and shadow. Time: by the clock of the processor or the "
              "device's shaders",
              kCostNames, view.cost);
    }
    {
        const Disabled none(view.mode != ViewMode::Noise && view.mode != ViewMode::Error &&
                                view.mode != ViewMode::Heat && view.mode != ViewMode::DenoisedError,
                            "the view has no scale");
        sliderReal("Scale",
                   "Of noise, errors and heat map: divides the value of the brightest colour, which the legend "
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
    const image::Image* held = gui.pinned.shown().get();
    if (held != nullptr && shown != nullptr && (shown->width != held->width || shown->height != held->height))
        note("The pinned picture is of another size and cannot be shown beside this one.");
    const Disabled rest(held == nullptr, "no picture is pinned (B)");
    combo("Compare by", "How the pinned picture A and the picture B are shown (V)", kCompareBys, gui.compareBy);
    row("A/B split", "Share of the pinned picture (B pins it)");
    ImGui::SliderFloat("##split", &gui.split, 0, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp);
    explainDisabled();
}

void drawViewports(Gui& gui) {
    constexpr app::Named<std::size_t> kCounts[] = {{"1", 1, "1", "The picture alone: that with the focus stays"},
                                                   {"2", 2, "2, side by side"},
                                                   {"4", 4, "4, two rows of two"}};
    std::size_t count = gui.viewportCount();
    if (combo(
            "Viewports",
            "Pictures of the scene beside each other, each with its settings, view and exposure, and an engine of its "
            "own. They take turns of equal time (F6; F7 or a press gives one the focus)",
            kCounts, count))
        wishViewports(gui, count);
    drawViewportQuestion(gui);
    const Disabled alone(gui.viewportCount() == 1, "there is one viewport");
    checkbox("Link cameras", "All viewports show the scene from where the one with the focus does (L)",
             gui.settings.linkCameras);
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
    if (button("Fit", "The whole picture (F); the wheel zooms, Ctrl + right drag moves it", true, width)) gui.view = {};
    ImGui::SameLine(0, space);
    const float pixel = 1 / ImGui::GetIO().DisplayFramebufferScale.x; // in the window's units
    if (button("1:1", "One pixel for each of the window", true, width)) gui.view = {pixel, 0, 0};
    checkbox("Pixel grid", "Lines between pixels, from 800 % on", gui.showGrid);
    checkbox("Histogram", "Of the picture's luminance", gui.showHistogram);
    if (gui.showHistogram) drawHistogram(gui);
    drawViewports(gui);
}

} // namespace rt::gui
