#include "Common/Gui/TimelineBar.h"

#include <algorithm>
#include <cmath>

#include <imgui.h>

#include "Common/Core/Format.h"
#include "Common/Gui/Icons.h"
#include "Common/Gui/ImGuiLayer.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {

void followTimeline(Gui& gui) {
    app::Timeline& timeline = gui.timeline;
    timeline.follow(gui.state, gui.editor.isDirty() || gui.editing.tool, ImGui::GetTime());
    if (const auto wish = timeline.next()) timeline.sent(gui.session.pose(wish->moment, wish->shutter));
    gui.editor.rest(timeline.isPlaying() || timeline.isWaiting());
}

void drawPlayButtons(Gui& gui) {
    app::Timeline& timeline = gui.timeline;
    const char* whyNot = timeline.whyNot();
    const Usable usable(whyNot == nullptr, whyNot),
        plays(whyNot != nullptr || timeline.motion().length > 0, "it is a pose");
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const bool isPlaying = timeline.isPlaying();
    if (iconButton("play", isPlaying ? Icon::Pause : Icon::Start,
                   isPlaying ? "Stops the motion (K)" : "Plays the motion as fast as pictures come (K)",
                   whyNot != nullptr ? usable : plays, isPlaying))
        timeline.play(!isPlaying);
    ImGui::SameLine(0, gap);
    if (button("<", "The frame before (,)", usable)) timeline.step(-1);
    ImGui::SameLine(0, gap);
    if (button(">", "The next frame (.)", usable)) timeline.step(1);
}

bool timeSlider(const char* id, const app::Timeline& timeline, double& seconds) {
    const double start = 0, end = timeline.length();
    const std::string format = formatted("%%.3f of %.3f s", end);
    double shown = seconds;
    const bool isChanged = ImGui::SliderScalar(id, ImGuiDataType_Double, &shown, &start, &end, format.c_str(),
                                               ImGuiSliderFlags_AlwaysClamp);
    if (!isChanged || !std::isfinite(shown) || shown == seconds) return false;
    seconds = shown;
    return true;
}

Rect drawTimelineBar(Gui& gui, const Rect& area) {
    app::Timeline& timeline = gui.timeline;
    if (!timeline.isMoving()) return area;
    const ImGuiViewport* viewport = ImGui::GetMainViewport();
    const ImVec2 padding = ImGui::GetStyle().WindowPadding;
    const float height = std::min(ImGui::GetFrameHeight() + padding.y, 0.5f * area.height);
    const Rect rest{area.x, area.y, area.width, std::max(1.0f, area.height - height)};
    ImGui::SetNextWindowPos({viewport->Pos.x + area.x, viewport->Pos.y + area.y + rest.height});
    ImGui::SetNextWindowSize({area.width, height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {padding.x, 0.5f * padding.y});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    constexpr ImGuiWindowFlags kStripFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                             ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                                             ImGuiWindowFlags_NoScrollWithMouse;
    if (ImGui::Begin("##timeline", nullptr, kStripFlags | kNeverDocks)) {
        drawPlayButtons(gui);
        ImGui::SameLine();
        const Disabled still(timeline.whyNot() != nullptr, timeline.whyNot());
        double seconds = timeline.time();
        ImGui::SetNextItemWidth(-1);
        if (timeSlider("##time", timeline, seconds)) timeline.goTo(seconds);
        tooltip("Seconds from the start of the animation; the panel Motion has the rest");
        explainDisabled();
    }
    ImGui::End();
    ImGui::PopStyleVar(2);
    return rest;
}

} // namespace rt::gui
