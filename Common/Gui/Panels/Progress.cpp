#include <string>

#include "Common/Core/Format.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Panels/StatusTexts.h"
#include "Common/Gui/Theme.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

// A dot in the colour of the engine, as in chips and in the chart; the rest of the line follows it.
void drawEngineDot(const Gui& gui) {
    const float em = ImGui::GetFontSize(), radius = 0.3f * em;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec4 color = engineColor(gui.isGpu, gui.settings.colorMode);
    ImGui::GetWindowDrawList()->AddCircleFilled({corner.x + radius, corner.y + 0.5f * ImGui::GetTextLineHeight()},
                                                radius, ImGui::ColorConvertFloat4ToU32(color));
    ImGui::Dummy({2 * radius, ImGui::GetTextLineHeight()});
    ImGui::SameLine(0, 0.4f * em);
}

} // namespace

void drawProgress(Gui& gui) {
    const app::SessionState& state = gui.state;
    const ProgressTexts texts = progressOf(state, gui.settings.request.timeLimit.value_or(0));
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::ProgressBar(texts.share, {-1, 0}, "");
    const ImVec2 bar = ImGui::GetItemRectSize();
    const ImVec2 extent = ImGui::CalcTextSize(texts.bar.c_str());
    ImGui::GetWindowDrawList()->AddText({corner.x + 0.5f * (bar.x - extent.x), corner.y + 0.5f * (bar.y - extent.y)},
                                        ImGui::GetColorU32(ImGuiCol_Text), texts.bar.c_str());
    const float room = ImGui::GetContentRegionAvail().x;
    ImGui::TextDisabled("%s", elided(texts.line, room).c_str());
    tooltip(texts.line.c_str());
    std::string last = "Last render: none yet"; // nothing moves when there is one
    std::string parts;
    if (state.lastRun) {
        const app::LastRun& run = *state.lastRun;
        last = "Last render " + shortDuration(run.seconds.render) + " (" + std::to_string(run.spp) + " spp)";
        parts =
            "The last render that ended, wall time of sampling alone, as in the statistics of a render without a "
            "window.\nLoad " +
            shortDuration(run.seconds.load) + ", build " + shortDuration(run.accelBuild + run.pipeline) +
            " (the scene's tree " + shortDuration(run.accelBuild) + ", pipelines of shaders " +
            shortDuration(run.pipeline) + "), render " + shortDuration(run.seconds.render);
    }
    ImGui::TextUnformatted(elided(last, room).c_str());
    if (!parts.empty()) tooltip(parts.c_str());
    ImGui::Separator();
}

// The right end gives way to what matters of the left one.
void drawStatusLine(Gui& gui) {
    const double zoom = 100.0 * static_cast<double>(gui.shownScale);
    // Of a window at rest the rate says nothing.
    const bool isMoving = gui.state.activity == app::Activity::Rendering || !gui.state.stage.empty();
    const std::string rate = isMoving ? formatted("%.0f fps   ", gui.figures.window.framesPerSecond) : "";
    const std::string fps = formatted("%.0f %%   ", zoom) + rate + "F1 help";
    const StatusParts parts = statusOf(gui.state);
    StatusParts minParts = parts;
    minParts.device.clear();
    drawEngineDot(gui);
    const float all = ImGui::GetContentRegionAvail().x;
    const float left = all - textWidth(fps) - 2 * ImGui::GetFontSize();
    const auto wholeOf = [](const StatusParts& some) { return fitStatus(some, 1e9f, textWidth); };
    const bool hasRight = textWidth(wholeOf(minParts)) <= left;
    ImGui::TextUnformatted(fitStatus(parts, hasRight ? left : all, textWidth).c_str());
    tooltip(wholeOf(parts).c_str());
    if (!hasRight) return;
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - textWidth(fps));
    ImGui::TextDisabled("%s", fps.c_str());
}

} // namespace rt::gui
