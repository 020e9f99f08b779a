#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "Common/Core/Printable.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

// The cameras that the scene has: its own, which may be one of those with names, and these.
void drawCameras(Gui& gui) {
    const scene::CompiledScene* scene = gui.state.scene.get();
    constexpr const char* kOwn = "From scene";
    std::vector<std::pair<std::string, scene::CameraDesc>> cameras;
    if (scene != nullptr) {
        const auto isOwn = [scene](const auto& named) { return named.second == scene->camera; };
        if (std::none_of(scene->cameras.begin(), scene->cameras.end(), isOwn))
            cameras.emplace_back(kOwn, scene->camera);
        cameras.insert(cameras.end(), scene->cameras.begin(), scene->cameras.end());
    }
    const auto at = std::find_if(cameras.begin(), cameras.end(),
                                 [&gui](const auto& named) { return named.second == gui.camera.home(); });
    std::string shown = at != cameras.end() ? printable(at->first) : kOwn;
    if (gui.camera.camera() != gui.camera.home()) shown += ", moved";
    const Disabled rest(cameras.size() < 2, "the scene has one camera");
    row("Camera", "Those that the scene has; R leads back to the one that is chosen");
    if (!ImGui::BeginCombo("##camera", shown.c_str())) return explainDisabled();
    for (const auto& [name, camera] : cameras) {
        ImGui::PushID(name.c_str());
        const bool isChosen = camera == gui.camera.home();
        if (ImGui::Selectable(printable(name).c_str(), isChosen)) gui.camera.setHome(camera);
        if (isChosen) ImGui::SetItemDefaultFocus();
        ImGui::PopID();
    }
    ImGui::EndCombo();
}

} // namespace

void drawCameraPanel(Gui& gui) {
    drawCameras(gui);
    scene::CameraDesc camera = gui.camera.camera();
    const double distance = glm::length(camera.lookAt - camera.lookFrom);
    bool changed = sliderReal("Field of view", "Vertical, in degrees", camera.verticalFov, 1, 170, "%.1f");
    changed |=
        sliderReal("Defocus angle",
                   "Of the cone of rays through the lens to the point in focus, in degrees; 0: everything is sharp",
                   camera.defocusAngle, 0, 20, "%.2f");
    // The range follows the scene's size: boxes of 500 units as well as spheres of one.
    changed |= sliderReal("Focus distance", "Where things are sharp, in units of the scene", camera.focusDistance,
                          std::min(camera.focusDistance, 0.01 * distance),
                          std::max(camera.focusDistance, 10 * distance), "%.4g", true);
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
    if (button("Focus on target", "Makes sharp what the camera looks at", true, half)) {
        camera.focusDistance = distance;
        changed = true;
    }
    ImGui::SameLine();
    if (button(gui.pickFocus ? "Click in the picture" : "Pick focus",
               "The next click in the picture makes sharp what is there; so does Ctrl + Shift + click at any time",
               true, half)) {
        gui.pickFocus = !gui.pickFocus;
    }
    bool moved = inputVector("Position", "Where the camera is", camera.lookFrom);
    moved |= inputVector("Target", "What it looks at", camera.lookAt);
    if (changed || moved) gui.camera.set(camera);
    if (moved && gui.camera.camera() != camera)
        gui.fail("No camera can look from this position at this target", app::ErrorSource::Camera);
    drawErrorOf(gui, app::ErrorSource::Camera);
    double speed = gui.camera.speed();
    row("Flying speed", "Units of the scene in a second; Alt + mouse wheel changes it");
    ImGui::Text("%.4g / s", speed);

    const float space = ImGui::GetStyle().ItemSpacing.x;
    const float width = (ImGui::GetContentRegionAvail().x - 2 * space) / 3;
    if (button("Frame all", "Moves back until all of the scene is in sight (Home)",
               {gui.state.scene != nullptr, "there is no scene yet"}, -1))
        gui.frameAll();
    if (button("Copy pose", "To the clipboard, as JSON (Ctrl+Shift+C)", true, width)) gui.copyPose();
    ImGui::SameLine(0, space);
    if (button("Paste pose", "From the clipboard (Ctrl+Shift+V)", true, width)) gui.pastePose();
    ImGui::SameLine(0, space);
    if (button("Reset", "Back to the chosen camera of the scene (R)", true, width)) gui.camera.reset();
    note("W A S D Q E fly, Shift fast, Ctrl slow; left drag orbits, right drag looks, middle drag pans.");
}

} // namespace rt::gui
