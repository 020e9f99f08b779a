#include <filesystem>
#include <string>

#include "Common/Gui/Panels.h"
#include "Common/Gui/Widgets.h"
#include "Common/Scene/BuiltinScenes.h"

namespace rt::gui {
namespace {

const scene::BuiltinScene* findBuiltin(const std::string& id) {
    for (const scene::BuiltinScene& scene : scene::builtinScenes())
        if (scene.id == id.substr(0, id.find(':'))) return &scene;
    return nullptr;
}

void drawSceneCombo(Gui& gui) {
    const std::string title = gui.state.scene ? gui.state.scene->title : "...";
    row("Scene", "Keys 1 to 9 choose the first nine, Page Up and Page Down the one before and behind");
    if (!ImGui::BeginCombo("##scene", title.c_str(), ImGuiComboFlags_HeightLarge)) return;
    for (const scene::BuiltinScene& scene : scene::builtinScenes()) {
        const bool selected = gui.state.source == scene.id;
        if (ImGui::Selectable(std::string(scene.title).c_str(), selected)) gui.openScene(std::string(scene.id));
        tooltip(std::string(scene.description).c_str());
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
    row("Open file", "A scene file (.json) or a model (.obj); files can also be dropped on the window (Ctrl+O)");
    const float width = ImGui::CalcTextSize("Open").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SetNextItemWidth(-width - ImGui::GetStyle().ItemInnerSpacing.x);
    if (gui.focusOpen) ImGui::SetKeyboardFocusHere();
    gui.focusOpen = false;
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
            ImGui::PushStyleColor(ImGuiCol_Text, ImVec4{0.90f, 0.62f, 0.10f, 1});
            ImGui::PushTextWrapPos(0);
            ImGui::TextUnformatted(("Notice: " + notice).c_str());
            ImGui::PopTextWrapPos();
            ImGui::PopStyleColor();
        }
    }
}

} // namespace rt::gui
