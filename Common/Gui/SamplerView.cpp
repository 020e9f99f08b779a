#include "Common/Gui/SamplerView.h"

#include <cmath>
#include <utility>

#include <imgui.h>

#include "Common/Gui/Gui.h"
#include "Common/Gui/PicturePlaces.h"

namespace rt::gui {
namespace {

constexpr float kPointRadius = 6, kReach = 11; // of the mark, and of the pointer that takes it, in the window's units

// Where the point's surface is seen now.
std::optional<ImVec2> markPlace(const Gui& gui, const Rect& image) {
    const auto state = gui.probe.state();
    if (!gui.sampling.isShown || !gui.sampling.point || !state || !state->whyNot.empty() || !gui.state.picture.image)
        return std::nullopt;
    const auto place = projectionOf(gui).place(glm::dvec3(state->result.position));
    if (!place) return std::nullopt;
    return inWindow(*place, image);
}

void setPoint(Gui& gui, const std::array<std::uint32_t, 2>& pixel) {
    const image::Image& picture = *gui.state.picture.image;
    gui.sampling.point =
        SamplerView::Point{gui.camera.camera(), pixel, {picture.width, picture.height}, gui.state.source};
}

} // namespace

probe::ProbeWish wishAt(const Gui& gui, const SamplerView::Point& point) {
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
    SamplerView& sampling = gui.sampling;
    if (sampling.point && sampling.point->source != gui.state.source) sampling.point.reset();
    if (!std::exchange(sampling.isShown, false)) {
        sampling.isPicking = sampling.isDragged = false;
        gui.probe.wish(std::nullopt);
    }
    if (const auto saved = gui.probe.takeSaved()) {
        if (saved->error.empty())
            gui.say("Saved " + saved->file);
        else
            gui.fail(saved->error, app::ErrorSource::Save);
    }
}

bool holdSampledPoint(Gui& gui, bool isInside, const std::optional<std::array<std::uint32_t, 2>>& pixel) {
    SamplerView& sampling = gui.sampling;
    if (!sampling.isShown || !gui.state.picture.image) return false;
    const ImGuiIO& io = ImGui::GetIO();
    if (isInside && io.MouseClicked[0]) {
        const auto mark = markPlace(gui, gui.shownImage);
        const bool isOnMark = mark && std::hypot(io.MousePos.x - mark->x, io.MousePos.y - mark->y) < kReach;
        sampling.isDragged = std::exchange(sampling.isPicking, false) || isOnMark;
        if (sampling.isDragged && !pixel) gui.say("The picture is elsewhere: nothing was picked");
    }
    if (!sampling.isDragged) return false;
    if (pixel && (io.MouseDown[0] || io.MouseClicked[0])) setPoint(gui, *pixel);
    if (!io.MouseDown[0]) sampling.isDragged = false; // its release selects nothing
    return true;
}

void drawSampledPoint(const Gui& gui, const Rect& image, const Rect& area) {
    const auto mark = markPlace(gui, image);
    if (!mark) return;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.PushClipRect({area.x, area.y}, {area.x + area.width, area.y + area.height});
    for (const bool isShadow : {true, false}) { // dark and light, so that it is seen on every picture
        const ImU32 color = isShadow ? IM_COL32(0, 0, 0, 180) : IM_COL32(80, 220, 255, 255);
        const float thickness = isShadow ? 4.0f : 2.0f, from = 0.4f * kPointRadius, to = 1.6f * kPointRadius;
        list.AddCircle(*mark, kPointRadius, color, 0, thickness);
        for (const ImVec2 way : {ImVec2(1, 0), ImVec2(-1, 0), ImVec2(0, 1), ImVec2(0, -1)})
            list.AddLine({mark->x + from * way.x, mark->y + from * way.y}, {mark->x + to * way.x, mark->y + to * way.y},
                         color, thickness);
    }
    list.PopClipRect();
}

} // namespace rt::gui
