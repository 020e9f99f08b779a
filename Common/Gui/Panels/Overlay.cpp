#include <algorithm>

#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Theme.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

constexpr double kToastSeconds = 5;
constexpr double kPatience = 0.3; // seconds before the user is told what takes so long

void drawBox(const char* name, const Rect& area, float y, float pivot, const std::string& text, const ImVec4& color) {
    constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                        ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoSavedSettings |
                                        ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;
    ImGui::SetNextWindowPos({area.x + 0.5f * area.width, y}, ImGuiCond_Always, {0.5f, pivot});
    ImGui::SetNextWindowBgAlpha(0.92f);
    ImGui::Begin(name, nullptr, kFlags);
    ImGui::PushTextWrapPos(std::max(80.0f, 0.8f * area.width));
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopStyleColor();
    ImGui::PopTextWrapPos();
    ImGui::End();
}

} // namespace

void drawOverlay(const Gui& gui, const Rect& area, float scale) {
    if (!gui.inspected.empty()) {
        ImGui::BeginTooltip();
        ImGui::TextUnformatted(gui.inspected.c_str());
        ImGui::EndTooltip();
    }
    const float margin = 12 * scale;
    const ImVec4 plain = ImGui::GetStyleColorVec4(ImGuiCol_Text);
    if (!gui.state.stage.empty() && gui.state.stageSeconds > kPatience) {
        const std::string text = gui.state.stage + " ... " + shortDuration(gui.state.stageSeconds);
        drawBox("##stage", area, area.y + margin, 0, text, plain);
    }
    if (!gui.toast.empty() && ImGui::GetTime() - gui.toastTime < kToastSeconds) {
        drawBox("##toast", area, area.y + area.height - margin, 1, gui.toast,
                gui.toastIsError ? errorColor(gui.settings.colorMode) : plain);
    }
}

} // namespace rt::gui
