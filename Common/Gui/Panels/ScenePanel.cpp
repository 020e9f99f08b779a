#include <cstdlib>
#include <string>

#include "Common/Core/Printable.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/TextFit.h"
#include "Common/Gui/Theme.h"
#include "Common/Gui/Widgets.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"

namespace rt::gui {
namespace {

constexpr float kThumbnail = 3.2f; // its side, in heights of the font

const scene::BuiltinScene* findBuiltin(const std::string& id) {
    for (const scene::BuiltinScene& scene : scene::builtinScenes())
        if (scene.id == id.substr(0, id.find(':'))) return &scene;
    return nullptr;
}

// The scene's thumbnail and title, which open the list of scenes.
void drawSceneButton(Gui& gui, const scene::BuiltinScene* builtin) {
    const std::string title = gui.state.scene ? gui.state.scene->title : "...";
    const float side = kThumbnail * ImGui::GetFontSize(), inner = ImGui::GetStyle().FramePadding.x;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    if (ImGui::Button("##scenes", {-1, side + 2 * inner})) gui.showScenes = !gui.showScenes;
    if (!gui.showScenes)
        tooltip("All scenes. Keys 1 to 9 choose the first nine, Page Up and Page Down the previous and the next");
    const ImVec2 end = ImGui::GetItemRectMax();
    if (!ImGui::IsItemVisible()) return;
    float left = corner.x + inner;
    if (builtin != nullptr && gui.thumbnails.draw(std::string(builtin->id), {left, corner.y + inner}, side))
        left += side + 2 * inner;
    const float width = end.x - left - inner;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddText({left, corner.y + inner}, ImGui::GetColorU32(ImGuiCol_Text), elided(title, width).c_str());
    const std::string description(builtin != nullptr ? builtin->description : gui.state.source);
    float top = corner.y + inner + 1.15f * ImGui::GetFontSize();
    for (const std::string& line : elidedLines(description, width, 2, textWidth)) {
        list.AddText({left, top}, ImGui::GetColorU32(ImGuiCol_TextDisabled), line.c_str());
        top += ImGui::GetFontSize();
    }
}

void drawSceneCount(Gui& gui, const scene::BuiltinScene& scene) {
    if (scene.defaultCount == 0) return;
    std::uint32_t count = scene.defaultCount;
    if (const std::size_t colon = gui.state.source.find(':'); colon != std::string::npos) {
        count = static_cast<std::uint32_t>(std::strtoul(gui.state.source.c_str() + colon + 1, nullptr, 10));
    }
    if (inputCount("Count", "How many spheres or lights the scene has", count, 1, scene::kMaxSceneCount, 0)) {
        gui.openScene(std::string(scene.id) + ":" + std::to_string(count));
    }
}

} // namespace

void drawScenePanel(Gui& gui) {
    const scene::BuiltinScene* builtin = findBuiltin(gui.state.source);
    drawSceneButton(gui, builtin);
    if (builtin != nullptr) drawSceneCount(gui, *builtin);
    const float space = ImGui::GetStyle().ItemSpacing.x;
    const float width = (ImGui::GetContentRegionAvail().x - space) / 2;
    if (button("Open file", "A scene file or a model; files can also be dropped on the window (Ctrl+O)", true, width))
        gui.browse(BrowseFor::Scene);
    ImGui::SameLine(0, space);
    if (button("Reload", "Reads the scene again", {!gui.state.source.empty(), "there is no scene yet"}, width))
        gui.openScene(gui.state.source);
    drawErrorOf(gui, app::ErrorSource::Scene);
    {
        const Disabled rest(builtin != nullptr, "the scene is built in, and no file");
        checkbox("Reload on change", "Reads a scene file again whenever it, or a model in it, has changed on the disk",
                 gui.settings.reloadScenes);
    }
    if (gui.state.scene) {
        for (const std::string& notice : gui.state.scene->notices)
            wrapped("Notice: " + printable(notice), noticeColor(gui.settings.colorMode));
    }
}

} // namespace rt::gui
