#include <algorithm>
#include <initializer_list>
#include <iterator>

#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Theme.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

struct HelpLine {
    const char* keys; // null: a group's title
    const char* effect;
};
constexpr HelpLine kLeft[] = {
    {nullptr, "Rendering"},
    {"Space", "start, pause, resume"},
    {"Ctrl+R", "restart"},
    {"N", "denoised picture, raw picture"},
    {"B", "pin the picture for A/B, unpin it"},
    {"V", "A/B split, blink, difference"},
    {"H", "heat map: what each pixel costs"},
    {"P", "preview without ray tracing (GPU)"},
    {"K; comma, period", "play the motion; one frame back, on"},
    {nullptr, "Scenes and files"},
    {"1 to 9", "the first nine scenes"},
    {"Page Up, Page Down", "previous, next scene"},
    {"Ctrl+O", "open a file; or drop it here"},
    {"F12, Ctrl+S", "save PNG and EXR"},
    {"Ctrl+Shift+S", "save as"},
    {"Ctrl+Z, Ctrl+Y", "undo, redo an edit of the scene"},
    {nullptr, "Window"},
    {"F1", "this help"},
    {"F2, F3, F4", "statistics, comparison, panels"},
    {"F5", "race of several settings"},
    {"F6", "1, 2 or 4 viewports"},
    {"F7, press in it", "focus on the next, on this one"},
    {"L", "link the cameras of viewports"},
    {"F11", "full screen"},
    {"Ctrl + plus, minus", "larger, smaller interface"},
    {"Tab, arrows, Enter", "walk through the controls"},
    {"Ctrl + click", "on a slider: type its value"},
    {"Escape", "leave a field, a menu, this help"},
    {"Ctrl+Q", "quit"},
};
constexpr HelpLine kRight[] = {
    {nullptr, "Camera"},
    {"Left drag", "orbit around the target"},
    {"Alt + left drag", "the same beside a pinned picture"},
    {"Right drag", "look around"},
    {"Middle drag", "pan"},
    {"W A S D, Q E", "fly; down, up"},
    {"Shift, Ctrl", "fly fast, slowly"},
    {"Alt + wheel", "flying speed"},
    {"Shift + wheel", "nearer, farther"},
    {"Ctrl+Shift + click", "make sharp what is there"},
    {"Home", "all of the scene"},
    {"R", "back to the chosen camera"},
    {"Ctrl+Shift+C, V", "copy, paste the pose"},
    {nullptr, "Picture"},
    {"Wheel", "zoom"},
    {"Ctrl + right drag", "move"},
    {"F", "fit, or frame what is selected"},
    {"Drag the cross", "the point of Sampler or Pixel noise"},
    {nullptr, "Objects"},
    {"Click, Escape", "select, deselect"},
    {"Ctrl + click", "select besides, or no longer"},
    {"G, R, S", "move, turn, scale what is selected"},
    {"X, Y, Z; Ctrl", "along that axis; by whole steps"},
    {"Drag a handle", "the same, with Shift of a copy"},
    {"Shift+D, Delete", "duplicate, delete"},
    {"H, Shift+H", "hide, hide all else"},
    {"Alt+H", "show all"},
};

constexpr float kMinLetters = 0.6f;

template <std::size_t N>
void drawColumn(const char* id, const HelpLine (&shortcuts)[N]) {
    if (!ImGui::BeginTable(id, 2, ImGuiTableFlags_SizingFixedFit)) return;
    for (const HelpLine& shortcut : shortcuts) {
        if (shortcut.keys == nullptr && &shortcut != &shortcuts[0]) { // a gap between groups
            ImGui::TableNextRow(ImGuiTableRowFlags_None, 0.6f * ImGui::GetFontSize());
        }
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        if (shortcut.keys == nullptr) {
            ImGui::TextColored(ImGui::GetStyleColorVec4(ImGuiCol_CheckMark), "%s", shortcut.effect);
            continue;
        }
        ImGui::TextUnformatted(shortcut.keys);
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(shortcut.effect);
    }
    ImGui::EndTable();
}

} // namespace

void drawHelp(Gui& gui) {
    if (!gui.showHelp) return;
    const ImVec2 size = ImGui::GetMainViewport()->Size;
    ImGui::SetNextWindowPos({0.5f * size.x, 0.5f * size.y}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {size.x, size.y});
    constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse |
                                        ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_HorizontalScrollbar;
    if (ImGui::Begin("Help", &gui.showHelp, kFlags)) {
        static ImVec2 whole{1, 1}; // of all of it, in letters of their own size, in the frame before
        const float margin = 3 * ImGui::GetFrameHeight();
        const float fit = std::min((size.x - margin) / whole.x, (size.y - margin) / whole.y);
        const float letters = std::clamp(fit, kMinLetters, 1.0f); // of a small window they are smaller
        ImGui::SetWindowFontScale(letters);
        const ImVec2 corner = ImGui::GetCursorPos();
        ImGui::BeginGroup();
        drawColumn("##left", kLeft);
        ImGui::EndGroup();
        ImGui::SameLine(0, 2 * ImGui::GetFontSize());
        ImGui::BeginGroup();
        drawColumn("##right", kRight);
        ImGui::EndGroup();
        ImGui::SameLine(0, 0);
        const float width = ImGui::GetCursorPosX() - corner.x;
        ImGui::NewLine();
        whole = {width / letters, (ImGui::GetCursorPosY() - corner.y) / letters};
    }
    ImGui::End();
}

void drawFirstSteps(Gui& gui, const Rect& area) {
    if (!gui.showFirstSteps || gui.errors.unread() != nullptr || hasMessage(gui)) return; // they stand there, too
    if (gui.viewportCount() > 1) return; // each of which is too narrow for them
    constexpr const char* kSteps[] = {"1  Press F3 and run the other engine: who is faster?",
                                      "2  Set Light sampling to Off: what aiming at lamps is worth",
                                      "3  Press N: the same picture, not denoised",
                                      "4  Click a ball: move it, make it of gold, add a light"};
    const float em = ImGui::GetFontSize(), padding = ImGui::GetStyle().WindowPadding.x;
    const float margin = std::min(em, 0.05f * area.width), room = std::max(1.0f, area.width - 2 * (margin + padding));
    float longest = 1;
    for (const char* step : kSteps) longest = std::max(longest, textWidth(step));
    ImGui::SetNextWindowPos({area.x + margin, area.y + area.height - margin}, ImGuiCond_Always, {0, 1});
    ImGui::SetNextWindowSizeConstraints(
        {1, 1}, {std::max(1.0f, area.width - 2 * margin), std::max(1.0f, area.height - 2 * margin)});
    constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                        ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                                        ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoMove;
    if (ImGui::Begin("##first-steps", nullptr, kFlags)) {
        ImGui::SetWindowFontScale(std::clamp(room / longest, kMinLetters, 1.0f)); // as in the help
        ImGui::PushTextWrapPos(padding + room);
        ImGui::TextDisabled("Four steps");
        for (const char* step : kSteps) ImGui::TextUnformatted(step);
        ImGui::PopTextWrapPos();
        if (ImGui::Button("Got it")) gui.showFirstSteps = false;
        ImGui::SameLine();
        ImGui::TextDisabled("F1 lists all keys");
    }
    ImGui::End();
}

} // namespace rt::gui
