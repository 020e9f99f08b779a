// The scene's objects as a tree, in which they are selected and hidden.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "Common/Core/Printable.h"
#include "Common/Gui/Icons.h"
#include "Common/Gui/Panels/ObjectFields.h"
#include "Common/Gui/Widgets.h"
#include "Common/Scene/Edit/Visibility.h"

namespace rt::gui {
namespace {

constexpr std::size_t kFewLines = 3, kManyLines = 7; // of the list's height
constexpr float kListShare = 0.35f;                  // of the panels' height at most: what is selected is seen below

// Anew only when it would be another one.
void refreshList(Gui& gui) {
    SceneEditing& editing = gui.editing;
    const scene::SceneDocument& document = *gui.editor.document();
    const bool isOfAnother = std::exchange(editing.listRevision, document.structure()) != document.structure();
    const bool isOtherSearch = std::exchange(editing.listSearch, editing.search) != editing.search;
    if (!isOfAnother && !isOtherSearch && !std::exchange(editing.isListStale, false)) return;
    editing.isListStale = false;
    editing.list.build(document.scene(), editing.open, editing.search);
}

void openAround(SceneEditing& editing, scene::ObjectPath path) {
    for (path.indices.pop_back(); !path.indices.empty(); path.indices.pop_back())
        editing.isListStale |= editing.open.insert(path).second;
}

// With Ctrl besides what is selected, or no longer; with Shift all rows from the one that was clicked last.
void selectRow(Gui& gui, std::size_t row, const scene::ObjectPath& path) {
    SceneEditing& editing = gui.editing;
    const std::size_t start = editing.rangeStart ? editing.list.find(*editing.rangeStart) : editing.list.size();
    if (ImGui::GetIO().KeyShift && start < editing.list.size()) {
        std::vector<scene::ObjectPath> paths;
        for (std::size_t i = std::min(start, row); i <= std::max(start, row); ++i)
            paths.push_back(editing.list.path(i));
        return gui.editor.select(std::move(paths), path);
    }
    editing.rangeStart = path;
    ImGui::GetIO().KeyCtrl ? gui.editor.toggle(path) : gui.editor.select(path);
}

// At the end of a row; whether it was pressed.
bool drawEye(bool isHidden, float side) {
    const ImVec2 corner{ImGui::GetCursorScreenPos().x + 0.25f * side, ImGui::GetCursorScreenPos().y};
    const bool isPressed = ImGui::InvisibleButton("##eye", {1.25f * side, side});
    tooltip(isHidden ? "Shows it again" : "Hides it: as if it were not there, and gave no light");
    const bool isLit = !isHidden || ImGui::IsItemHovered();
    drawIcon(*ImGui::GetWindowDrawList(), isHidden ? Icon::ClosedEye : Icon::Eye, corner, side,
             ImGui::GetColorU32(isLit ? ImGuiCol_Text : ImGuiCol_TextDisabled));
    return isPressed;
}

void drawObjectRow(Gui& gui, std::size_t row) {
    SceneEditing& editing = gui.editing;
    const scene::ObjectPath path = editing.list.path(row);
    const scene::ObjectDesc* object = findObject(gui.editor.document()->scene(), path);
    if (object == nullptr) return;
    ImGui::PushID(static_cast<int>(row));
    const float side = ImGui::GetFontSize();
    if (editing.list.depth(row) > 0) ImGui::Indent(side * static_cast<float>(editing.list.depth(row)));
    const bool isGroup = std::holds_alternative<scene::GroupDesc>(object->shape) && editing.listSearch.empty();
    if (isGroup) {
        const bool isOpen = editing.open.contains(path);
        ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, 0}); // all rows are of one height
        const bool isPressed = ImGui::ArrowButton("##open", isOpen ? ImGuiDir_Down : ImGuiDir_Right);
        ImGui::PopStyleVar();
        if (isPressed) {
            isOpen ? (void)editing.open.erase(path) : (void)editing.open.insert(path);
            editing.isListStale = true;
        }
        ImGui::SameLine();
    }
    const std::string label = std::to_string(path.indices.back()) + "  " + printable(app::labelOf(*object), 60);
    const bool isShownHere = isShown(gui.editor.document()->scene(), path), isHidden = object->hidden;
    const float eye = ImGui::GetTextLineHeight(), width = ImGui::GetContentRegionAvail().x - 1.5f * eye;
    if (!isShownHere) ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    const ImVec2 size{std::max(1.0f, width), 0};
    if (ImGui::Selectable(label.c_str(), gui.editor.selected().contains(path), 0, size)) selectRow(gui, row, path);
    if (!isShownHere) ImGui::PopStyleColor();
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0)) frameSelection(gui);
    ImGui::SameLine(0, 0);
    if (drawEye(isHidden, eye)) hideObjects(gui, {path}, !isHidden);
    if (editing.list.depth(row) > 0) ImGui::Unindent(side * static_cast<float>(editing.list.depth(row)));
    ImGui::PopID();
}

// Looked for once for each change of the scene: it may be large.
bool isAnyHidden(Gui& gui) {
    SceneEditing& editing = gui.editing;
    const scene::SceneDocument& document = *gui.editor.document();
    if (std::exchange(editing.hiddenRevision, document.revision()) != document.revision())
        editing.isAnyHidden = !allShown(document.scene()).empty();
    return editing.isAnyHidden;
}

} // namespace

void drawObjectTree(Gui& gui) {
    SceneEditing& editing = gui.editing;
    ImGui::SetNextItemWidth(-buttonWidth("Show all") - ImGui::GetStyle().ItemSpacing.x);
    inputText("##search", "Search objects and materials", editing.search);
    ImGui::SameLine();
    if (button("Show all", "All objects that are hidden (Alt+H)", {isAnyHidden(gui), "nothing is hidden"}))
        showAllObjects(gui);
    if (editing.revealsSelection && gui.editor.selection()) openAround(editing, *gui.editor.selection());
    refreshList(gui);
    const float line = ImGui::GetFrameHeightWithSpacing();
    const auto fitting = static_cast<std::size_t>(std::max(0.0f, kListShare * ImGui::GetWindowHeight() / line));
    const std::size_t most = std::clamp(fitting, kFewLines, kManyLines);
    const auto lines = static_cast<float>(std::clamp(editing.list.size() + 1, kFewLines, most));
    if (ImGui::BeginChild("##tree", {0, lines * line}, true)) {
        const float height = ImGui::GetTextLineHeightWithSpacing();
        if (std::exchange(editing.revealsSelection, false) && gui.editor.selection()) {
            const std::size_t row = editing.list.find(*gui.editor.selection());
            ImGui::SetScrollY(std::max(0.0f, (static_cast<float>(row) - 0.5f * lines) * height));
        }
        ImGuiListClipper clipper;
        clipper.Begin(static_cast<int>(editing.list.size()), height);
        while (clipper.Step())
            for (int row = clipper.DisplayStart; row < clipper.DisplayEnd; ++row)
                drawObjectRow(gui, static_cast<std::size_t>(row));
    }
    ImGui::EndChild();
}

} // namespace rt::gui
