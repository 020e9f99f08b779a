#include <algorithm>
#include <vector>

#include "Common/Gui/Icons.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Theme.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

constexpr double kPatience = 0.3; // seconds before the user is told what takes so long
constexpr ImGuiWindowFlags kBoxFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                       ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                       ImGuiWindowFlags_NoNav;

void beginBox(const char* name, const Rect& area, float y, float pivot, ImGuiWindowFlags flags) {
    ImGui::SetNextWindowPos({area.x + 0.5f * area.width, y}, ImGuiCond_Always, {0.5f, pivot});
    ImGui::SetNextWindowBgAlpha(0.95f);
    // Over the picture alone, however large the letters are.
    ImGui::SetNextWindowSizeConstraints({1, 1}, {std::max(1.0f, area.width), std::max(1.0f, 0.9f * area.height)});
    ImGui::Begin(name, nullptr, kBoxFlags | flags);
}

void drawBox(const char* name, const Rect& area, float y, float pivot, const std::string& text) {
    beginBox(name, area, y, pivot, ImGuiWindowFlags_NoInputs);
    ImGui::PushTextWrapPos(std::max(80.0f, 0.8f * area.width));
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::End();
}

// Stays until the user has read it.
void drawError(Gui& gui, const Rect& area, float y) {
    const app::ErrorEntry* error = gui.errors.unread();
    if (error == nullptr) return;
    beginBox("##error", area, y, 1, ImGuiWindowFlags_None);
    const std::string times = error->count > 1 ? " (" + std::to_string(error->count) + " times)" : "";
    ImGui::PushTextWrapPos(std::max(80.0f, 0.7f * area.width));
    ImGui::PushStyleColor(ImGuiCol_Text, errorColor(gui.settings.colorMode));
    ImGui::TextUnformatted((error->text + times).c_str());
    ImGui::PopStyleColor();
    ImGui::PopTextWrapPos();
    const std::size_t count = gui.errors.unreadCount();
    if (ImGui::Button(count > 1 ? "Next" : "Dismiss")) gui.errors.dismiss(*error);
    if (count > 1) {
        ImGui::SameLine();
        if (ImGui::Button(("Dismiss all " + std::to_string(count)).c_str())) gui.errors.dismissAll();
    }
    ImGui::End();
}

bool hasHeld(const std::vector<InspectedRow>& rows) {
    return std::any_of(rows.begin(), rows.end(), [](const InspectedRow& row) { return !row.held.empty(); });
}

// Of a tooltip with a table of them.
float tableWidth(const std::vector<InspectedRow>& rows) {
    float name = 0, picture = 0, held = 0, difference = 0;
    for (const InspectedRow& row : rows) {
        name = std::max(name, textWidth(row.name));
        picture = std::max(picture, textWidth(row.picture));
        held = std::max(held, textWidth(row.held));
        difference = std::max(difference, textWidth(row.difference));
    }
    const ImGuiStyle& style = ImGui::GetStyle();
    const float columns = hasHeld(rows) ? 4 : 2;
    return name + picture + held + difference + 2 * columns * style.CellPadding.x + 2 * style.WindowPadding.x;
}

void drawInspectedTable(const std::vector<InspectedRow>& rows) {
    const bool all = hasHeld(rows);
    if (!ImGui::BeginTable("##inspected", all ? 4 : 2, ImGuiTableFlags_SizingFixedFit)) return;
    const auto cell = [](const std::string& text) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(text.c_str());
    };
    for (const InspectedRow& row : rows) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextDisabled("%s", row.name.c_str());
        if (all) cell(row.held);
        cell(row.picture);
        if (all) cell(row.difference);
    }
    ImGui::EndTable();
}

// At the pointer, or above and to the left of it where the window ends. In a narrow window stands below each other what
// there is no room for side by side.
void drawInspector(const Gui& gui) {
    if (gui.inspected.empty()) return;
    const float room = ImGui::GetMainViewport()->Size.x;
    const std::vector<InspectedRow> rows = tableWidth(gui.inspected) <= room ? gui.inspected : stacked(gui.inspected);
    ImGui::BeginTooltip();
    if (tableWidth(rows) <= room) {
        drawInspectedTable(rows);
    } else {
        ImGui::PushTextWrapPos(std::max(1.0f, room - ImGui::GetStyle().WindowPadding.x));
        for (const InspectedRow& row : rows) {
            ImGui::TextDisabled("%s", row.name.c_str());
            ImGui::TextUnformatted(row.picture.c_str());
        }
        ImGui::PopTextWrapPos();
    }
    ImGui::EndTooltip();
}

} // namespace

bool hasMessage(const Gui& gui) {
    constexpr double kMessageSeconds = 5;
    const bool isCovered = gui.errors.unread() != nullptr;
    return !isCovered && !gui.message.empty() && ImGui::GetTime() - gui.messageTime < kMessageSeconds;
}

void drawOverlay(Gui& gui, const Rect& area, float scale) {
    drawInspector(gui);
    const float margin = 12 * scale;
    if (!gui.state.stage.empty() && gui.state.stageSeconds > kPatience) {
        const std::string text = gui.state.stage + " ... " + shortDuration(gui.state.stageSeconds);
        drawBox("##stage", area, area.y + margin, 0, text);
    }
    const float bottom = area.y + area.height - margin - legendHeight(gui, area, scale);
    drawError(gui, area, bottom);
    if (hasMessage(gui)) drawBox("##message", area, bottom, 1, gui.message);
}

void drawErrors(Gui& gui) {
    if (!gui.showErrors) return;
    placeNextWindow({44, 24}, {0.9f, 0.8f});
    if (ImGui::Begin("What went wrong", &gui.showErrors,
                     ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings)) {
        if (button("Clear", "Forgets them all", {!gui.errors.all().empty(), "nothing went wrong so far"}))
            gui.errors.clear();
        ImGui::BeginChild("##list");
        if (gui.errors.all().empty()) note("Nothing so far");
        for (auto entry = gui.errors.all().rbegin(); entry != gui.errors.all().rend(); ++entry) {
            const std::string times = entry->count > 1 ? " (" + std::to_string(entry->count) + " times)" : "";
            wrapped(entry->text + times,
                    entry->isRead ? ImGui::GetStyleColorVec4(ImGuiCol_Text) : errorColor(gui.settings.colorMode));
            ImGui::Separator();
        }
        ImGui::EndChild();
    }
    ImGui::End();
}

void drawErrorOf(Gui& gui, app::ErrorSource source) {
    const app::ErrorEntry* error = gui.errors.unread(source);
    if (error == nullptr) return;
    ImGui::PushID(static_cast<int>(source));
    if (iconButton("dismiss", Icon::Close, "Dismiss")) {
        gui.errors.dismiss(*error);
    } else {
        ImGui::SameLine();
        wrapped(error->text, errorColor(gui.settings.colorMode));
    }
    ImGui::PopID();
}

} // namespace rt::gui
