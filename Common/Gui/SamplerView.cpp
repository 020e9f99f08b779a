#include "Common/Gui/SamplerView.h"

#include "Common/Gui/Gui.h"

namespace rt::gui {
namespace {

constexpr ImU32 kSampledColor = IM_COL32(80, 220, 255, 255);

// Where the point's surface is seen now.
std::optional<ImVec2> sampledMark(const Gui& gui, const Rect& image) {
    const auto state = gui.probe.state();
    if (!gui.sampling.isShown || !gui.sampling.point || !state || !state->whyNot.empty() || !gui.state.picture.image)
        return std::nullopt;
    return placeInWindow(gui, glm::dvec3(state->result.position), image);
}

} // namespace

probe::ProbeWish wishAt(const Gui& gui, const PickedPixel& point) {
    const app::RenderSettings& film = gui.state.settings;
    app::RenderSettings rendering; // what makes no difference stays as it is by default
    rendering.width = point.size[0];
    rendering.height = point.size[1];
    rendering.maxDepth = film.maxDepth;
    rendering.lightSampling = film.lightSampling;
    rendering.lightSelection = film.lightSelection;
    rendering.sphereLight = film.sphereLight;
    rendering.quadLight = film.quadLight;
    rendering.triangleLight = film.triangleLight;
    return {gui.state.scene, rendering, point.camera, point.pixel, gui.sampling.settings};
}

void followSampler(Gui& gui) {
    if (!followPicker(gui, gui.sampling)) gui.probe.wish(std::nullopt);
    if (const auto saved = gui.probe.takeSaved()) {
        if (saved->error.empty())
            gui.say("Saved " + saved->file);
        else
            gui.fail(saved->error, app::ErrorSource::Save);
    }
}

bool holdSampledPoint(Gui& gui, bool isInside, const std::optional<std::array<std::uint32_t, 2>>& pixel) {
    return holdPoint(gui, gui.sampling, sampledMark(gui, gui.shownImage), isInside, pixel);
}

void drawSampledPoint(const Gui& gui, const Rect& image, const Rect& area) {
    if (const auto mark = sampledMark(gui, image)) drawPointMark(*mark, area, kSampledColor);
}

} // namespace rt::gui
