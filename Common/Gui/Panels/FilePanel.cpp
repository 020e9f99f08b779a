// Files that are opened and written.
#include <filesystem>
#include <string>
#include <vector>

#include "Common/Core/Printable.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

void drawRecent(Gui& gui) {
    row("Recent files", "Scene files that were opened, the latest first");
    const Disabled rest(gui.settings.recent.empty(), "no file was opened yet");
    if (!ImGui::BeginCombo("##recent", gui.settings.recent.empty() ? "none yet" : "Open again"))
        return explainDisabled();
    for (const std::string& file : std::vector<std::string>(gui.settings.recent)) { // choosing one changes their order
        ImGui::PushID(file.c_str());
        const std::string name = printable(std::filesystem::path(file).filename().string());
        if (ImGui::Selectable(name.c_str(), file == gui.state.source)) gui.openScene(file);
        tooltip(printable(file).c_str());
        ImGui::PopID();
    }
    ImGui::EndCombo();
}

} // namespace

void drawFilePanel(Gui& gui) {
    const float space = ImGui::GetStyle().ItemSpacing.x;
    const float width = (ImGui::GetContentRegionAvail().x - space) / 2;
    if (button("Open a scene", "A scene file or a model (Ctrl+O)", true, width)) gui.browse(BrowseFor::Scene);
    ImGui::SameLine(0, space);
    if (button("Export the scene", "As a scene file (.json) or glTF (.glb, .gltf)",
               {gui.state.scene != nullptr, "there is no scene yet"}, width))
        gui.exportScene();
    drawRecent(gui);
    row("Save to", "Folder for F12; empty: your pictures folder, else the home folder");
    inputText("##folder", "pictures folder", gui.settings.saveFolder);
    combo("Save which", "Of the raw and the denoised picture; a film without halves has the raw one alone",
          app::kSaveChoices, gui.settings.saveChoice);
    drawErrorOf(gui, app::ErrorSource::Save);
    const Usable hasPicture{gui.state.picture.image != nullptr, "there is no picture yet"};
    if (button("Save PNG and EXR", "F12 or Ctrl+S", hasPicture, width)) gui.saveRequested = true;
    ImGui::SameLine(0, space);
    if (button("Save as", "Ctrl+Shift+S", hasPicture, width)) gui.browse(BrowseFor::Picture);
}

} // namespace rt::gui
