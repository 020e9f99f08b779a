#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>

#include "Common/Core/Printable.h"
#include "Common/Gui/Panels/Panels.h"
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

// A thumbnail, the title and the line of description; whether it was chosen.
bool drawChoice(Gui& gui, const scene::BuiltinScene& scene, bool selected) {
    const float font = ImGui::GetFontSize(), side = kThumbnail * font;
    ImGui::PushID(scene.id.data());
    const bool chosen = ImGui::Selectable("##choice", selected, 0, {0, side});
    ImGui::PopID();
    const ImVec2 corner = ImGui::GetItemRectMin();
    if (!ImGui::IsItemVisible()) return chosen;
    gui.thumbnails.draw(std::string(scene.id), corner, side);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float left = corner.x + side + 0.5f * font;
    const float width = std::max(1.0f, ImGui::GetItemRectMax().x - left);
    list.AddText({left, corner.y}, ImGui::GetColorU32(ImGuiCol_Text), scene.title.data(),
                 scene.title.data() + scene.title.size());
    list.AddText(ImGui::GetFont(), font, {left, corner.y + 1.1f * font}, ImGui::GetColorU32(ImGuiCol_TextDisabled),
                 scene.description.data(), scene.description.data() + scene.description.size(), width);
    return chosen;
}

void drawSceneCombo(Gui& gui) {
    const std::string title = gui.state.scene ? gui.state.scene->title : "...";
    ImGui::SetNextItemWidth(-1); // without a label: titles are long
    const float font = ImGui::GetFontSize();
    const ImVec2 most{36 * font, 0.8f * ImGui::GetMainViewport()->Size.y};
    ImGui::SetNextWindowSizeConstraints({std::min(most.x, 0.9f * ImGui::GetMainViewport()->Size.x), 0}, most);
    const bool isOpen = ImGui::BeginCombo("##scene", title.c_str());
    if (!isOpen) return tooltip("Keys 1 to 9 choose the first nine, Page Up and Page Down the previous and the next");
    for (const scene::BuiltinScene& scene : scene::builtinScenes()) {
        const bool selected = findBuiltin(gui.state.source) == &scene;
        if (drawChoice(gui, scene, selected)) gui.openScene(std::string(scene.id));
        if (selected) ImGui::SetItemDefaultFocus();
    }
    ImGui::EndCombo();
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

void drawFiles(Gui& gui) {
    row("Open file", "A scene file (.json) or a model (.gltf, .glb, .obj); files can also be dropped on the window (Ctrl+O)");
    const float width = ImGui::CalcTextSize("Open").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SetNextItemWidth(-width - ImGui::GetStyle().ItemInnerSpacing.x);
    if (std::exchange(gui.focusOpen, false)) {
        ImGui::SetWindowFocus(); // ImGui 1.90 looks for the field in the window that had the focus before
        ImGui::SetKeyboardFocusHere();
    }
    const bool entered = inputText("##path", "path", gui.path);
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    if ((button("Open", nullptr, !gui.path.empty()) || entered) && !gui.path.empty()) gui.openScene(gui.path);
    if (!gui.settings.recent.empty()) {
        row("Recent", nullptr);
        if (ImGui::BeginCombo("##recent", "files opened before")) {
            for (const std::string& file : std::vector<std::string>(gui.settings.recent)) {
                ImGui::PushID(file.c_str());
                if (ImGui::Selectable(std::filesystem::path(file).filename().string().c_str())) gui.openScene(file);
                tooltip(file.c_str());
                ImGui::PopID();
            }
            ImGui::EndCombo();
        }
    }
}

} // namespace

void drawScenePanel(Gui& gui) {
    drawSceneCombo(gui);
    if (const scene::BuiltinScene* builtin = findBuiltin(gui.state.source)) {
        const float side = kThumbnail * ImGui::GetFontSize();
        if (gui.thumbnails.draw(std::string(builtin->id), ImGui::GetCursorScreenPos(), side)) {
            ImGui::Dummy({side, side});
            ImGui::SameLine();
        }
        note(std::string(builtin->description));
        drawSceneCount(gui, *builtin);
    } else if (!gui.state.source.empty()) {
        note(gui.state.source);
    }
    drawFiles(gui);
    if (button("Reload", "Reads the scene again, as after its file has changed", !gui.state.source.empty(), -1)) {
        gui.openScene(gui.state.source);
    }
    if (gui.state.scene) {
        for (const std::string& notice : gui.state.scene->notices) {
            ImGui::PushStyleColor(ImGuiCol_Text, noticeColor(gui.settings.colorMode));
            ImGui::PushTextWrapPos(0);
            ImGui::TextUnformatted(("Notice: " + printable(notice)).c_str());
            ImGui::PopTextWrapPos();
            ImGui::PopStyleColor();
        }
    }
}

} // namespace rt::gui
