// The library of materials, in a grid of small pictures by groups: a click is for what is selected, a drag for what is
// under the pointer in the picture.
#include <algorithm>
#include <string>
#include <vector>

#include "Common/Core/Printable.h"
#include "Common/Gui/Panels/ObjectFields.h"
#include "Common/Gui/TextFit.h"
#include "Common/Gui/Theme.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

constexpr float kPlace = 4.6f;        // the width of a material's place at least, in heights of the font
constexpr float kPlaceMargin = 0.25f; // around what is in it
constexpr float kListHeight = 17;     // two rows and the name of a group: what is below stays in sight

void drawPicture(Gui& gui, const app::MaterialPreset& preset, ImVec2 corner, float side) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (!gui.materialPictures.draw(preset.picture(), corner, side))
        list.AddRectFilled(corner, {corner.x + side, corner.y + side}, ImGui::GetColorU32(ImGuiCol_FrameBg));
}

// Beside the pointer while the material is dragged.
void drawDragged(Gui& gui, const app::MaterialPreset& preset) {
    const float side = 3 * ImGui::GetFontSize();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::Dummy({side, side});
    drawPicture(gui, preset, corner, side);
    ImGui::SameLine();
    ImGui::TextUnformatted((preset.name + "\nonto an object in the picture").c_str());
}

void explain(const app::MaterialPreset& preset) {
    std::string text = preset.name + " (" + preset.group + ")\nClick: for what is selected. Drag: onto an object.";
    if (!preset.source.empty()) text += "\n" + printable(preset.source);
    tooltip(text.c_str());
}

void drawPlace(Gui& gui, std::size_t index, float width) {
    const app::MaterialPreset& preset = materialPresets(gui)[index];
    const float em = ImGui::GetFontSize(), margin = kPlaceMargin * em;
    const float side = width - 2 * margin, lines = 2 * ImGui::GetTextLineHeight();
    ImGui::PushID(static_cast<int>(index));
    const bool isChosen = ImGui::Selectable("##material", false, 0, {width, side + 3 * margin + lines});
    if (ImGui::BeginDragDropSource()) {
        gui.materials.dragged = index;
        ImGui::SetDragDropPayload("material", &index, sizeof index);
        drawDragged(gui, preset);
        ImGui::EndDragDropSource();
    } else if (!gui.materials.dragged) {
        explain(preset);
    }
    ImGui::PopID();
    if (isChosen && !gui.materials.dragged) {
        const std::vector<scene::ObjectPath>& objects = gui.editor.selected().paths();
        objects.empty() ? gui.say("Select an object first, or drag the material onto one")
                        : giveMaterial(gui, objects, *preset.scene, preset.name);
    }
    if (!ImGui::IsItemVisible()) return;
    const ImVec2 corner(ImGui::GetItemRectMin().x + margin, ImGui::GetItemRectMin().y + margin);
    drawPicture(gui, preset, corner, side);
    float top = corner.y + side + 0.5f * margin;
    for (const std::string& line : elidedLines(preset.name, width, 2, textWidth)) {
        ImGui::GetWindowDrawList()->AddText({corner.x - margin, top}, ImGui::GetColorU32(ImGuiCol_Text), line.c_str());
        top += ImGui::GetTextLineHeight();
    }
}

// Those of a group that the search finds; whether there are any.
bool drawGroup(Gui& gui, std::size_t first, std::size_t last) {
    const std::vector<app::MaterialPreset>& presets = materialPresets(gui);
    std::vector<std::size_t> found;
    for (std::size_t i = first; i < last; ++i)
        if (presets[i].matches(gui.materials.search)) found.push_back(i);
    if (found.empty()) return false;
    ImGui::TextDisabled("%s", presets[first].group.c_str());
    const float gap = 0.25f * ImGui::GetFontSize(), room = ImGui::GetContentRegionAvail().x;
    const int columns = std::max(1, static_cast<int>((room + gap) / (kPlace * ImGui::GetFontSize() + gap)));
    const float width = (room - gap * static_cast<float>(columns - 1)) / static_cast<float>(columns);
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (i % static_cast<std::size_t>(columns) != 0) ImGui::SameLine(0, gap);
        drawPlace(gui, found[i], width);
    }
    return true;
}

void drawPipette(Gui& gui) {
    const bool isOn = gui.materials.isPicking;
    const char* tip = "The next click in the picture: its material is for what is selected (Escape: none)";
    const bool isSelected = gui.editor.selection().has_value();
    if (!button(isOn ? "Stop picking" : "Pipette", tip, {isSelected, "nothing is selected"}, -1)) return;
    if (isOn)
        gui.materials.isPicking = false;
    else
        beginPipette(gui);
}

void drawMaterialFiles(Gui& gui) {
    const float space = ImGui::GetStyle().ItemSpacing.x, width = (ImGui::GetContentRegionAvail().x - space) / 2;
    const char* tip = "All materials of a .mtlx file; what is selected gets the first. Or drop the file onto an object";
    if (button("Open MaterialX...", tip, true, width)) gui.browse(BrowseFor::OpenMaterial);
    ImGui::SameLine(0, space);
    const bool hasMaterial = !selectedMaterial(gui).empty();
    if (button("Save MaterialX...", "The material of what is selected, as a .mtlx file",
               {hasMaterial, "nothing with a material of the scene is selected"}, width))
        gui.browse(BrowseFor::SaveMaterial);
    for (const std::string& notice : gui.materials.notices)
        wrapped("Notice: " + printable(notice), noticeColor(gui.settings.colorMode));
}

} // namespace

void drawMaterialLibrary(Gui& gui) {
    drawPipette(gui);
    drawMaterialFiles(gui);
    ImGui::SetNextItemWidth(-1);
    inputText("##materials", "Search materials", gui.materials.search);
    const std::vector<app::MaterialPreset>& presets = materialPresets(gui);
    ImGui::BeginChild("##library", {0, kListHeight * ImGui::GetFontSize()}, true);
    bool hasAny = false;
    for (std::size_t first = 0, last = 0; first < presets.size(); first = last) {
        while (last < presets.size() && presets[last].group == presets[first].group) ++last;
        hasAny |= drawGroup(gui, first, last);
    }
    if (!hasAny)
        note(presets.empty() ? "There is no library: the folder materials of the assets is missing"
                             : "No material of that name");
    ImGui::EndChild();
}

} // namespace rt::gui
