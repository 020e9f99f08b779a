#include "Common/Gui/Panels/Panels.h"

namespace rt::gui {
namespace {

struct Shortcut {
    const char* keys;
    const char* effect;
};
constexpr Shortcut kShortcuts[] = {
    {"F1", "this help"},
    {"F2, F3, F4", "statistics, comparison, all panels"},
    {"F11", "full screen"},
    {"F12, Ctrl+S", "save PNG and EXR"},
    {"Space", "pause, resume"},
    {"Ctrl+R", "restart the render"},
    {"1 to 9", "the first nine scenes"},
    {"Page Up, Page Down", "previous, next scene"},
    {"Ctrl+O", "open a file; or drop it on the window"},
    {"Ctrl+Q", "quit"},
    {"R", "camera back to the scene's"},
    {"W A S D, Q E", "fly; down, up"},
    {"Shift, Ctrl", "fly fast, slowly"},
    {"Right drag", "look around"},
    {"Left drag", "orbit around the target; with a pinned picture: Alt + left drag"},
    {"Middle drag", "pan"},
    {"Ctrl + click", "make sharp what is there"},
    {"Wheel", "flying speed; with Shift: nearer, farther"},
    {"Ctrl + wheel", "zoom the picture"},
    {"Ctrl + right drag", "move the picture"},
    {"F", "fit the picture"},
    {"P", "preview without ray tracing, and back (ray-tracing-gpu)"},
    {"H", "heat map: what each pixel costs, in rays or time"},
    {"B", "pin the picture for A/B comparison, unpin it"},
    {"Ctrl+Shift+C, V", "copy, paste the camera's pose"},
    {"Ctrl + plus, minus", "larger, smaller interface"},
    {"Tab, arrows, Enter", "go to the panels, walk through their controls, use them"},
    {"Ctrl + click, on a slider", "type its value"},
    {"Escape", "leave a field, a menu, the controls, this help"},
};

} // namespace

void drawHelp(Gui& gui) {
    if (!gui.showHelp) return;
    const ImVec2 size = ImGui::GetMainViewport()->Size;
    ImGui::SetNextWindowPos({0.5f * size.x, 0.5f * size.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {size.x, size.y});
    if (ImGui::Begin(
            "Help", &gui.showHelp,
            ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings)) {
        if (ImGui::BeginTable("##keys", 2, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) {
            for (const Shortcut& shortcut : kShortcuts) {
                ImGui::TableNextRow();
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(shortcut.keys);
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(shortcut.effect);
            }
            ImGui::EndTable();
        }
    }
    ImGui::End();
}

} // namespace rt::gui
