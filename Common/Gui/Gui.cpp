#include "Common/Gui/Gui.h"

#include <algorithm>
#include <filesystem>

#include <imgui.h>

#include "Common/Scene/Builtin/BuiltinScenes.h"

namespace rt::gui {

void Gui::openScene(const std::string& source) {
    std::error_code none;
    const bool isFile = std::filesystem::exists(source, none);
    session.open(isFile ? std::filesystem::absolute(source, none).string() : source);
}

void Gui::stepScene(int step) {
    const auto scenes = scene::builtinScenes();
    const std::string id = state.source.substr(0, state.source.find(':'));
    const auto count = static_cast<int>(scenes.size());
    const auto at = std::find_if(scenes.begin(), scenes.end(), [&](const auto& scene) { return scene.id == id; });
    int index = at != scenes.end() ? static_cast<int>(at - scenes.begin()) + step : 0;
    index = (index + count) % count;
    openScene(std::string(scenes[static_cast<std::size_t>(index)].id));
}

void Gui::hold() {
    held = held ? nullptr : state.picture.image;
    heldIsDisplay = state.picture.isDisplay;
    split = 0.5f;
}

void Gui::copyPose() {
    window.setClipboard(app::CameraController::toText(camera.camera()));
    say("Pose copied", false);
}

void Gui::pastePose() {
    if (const auto pose = app::CameraController::fromText(window.clipboard(), camera.camera())) {
        camera.set(*pose);
    } else {
        say("The clipboard holds no camera pose", true);
    }
}

// Off, rays, time where that is known, off.
void Gui::toggleHeatMap() {
    if (!state.canShowCost) return;
    const bool isOn = viewRequest.mode == app::ViewMode::Heat;
    const bool hasNext = isOn && viewRequest.cost == app::Cost::Rays && state.canShowTime;
    viewRequest.mode = isOn && !hasNext ? app::ViewMode::Picture : app::ViewMode::Heat;
    viewRequest.cost = hasNext ? app::Cost::Time : app::Cost::Rays;
}

void Gui::toggleStatistics() {
    bool& isOpen = settings.openPanels["statistics"];
    settings.showStatistics = !(settings.showPanels && settings.showStatistics && isOpen);
    if (settings.showStatistics) {
        settings.showPanels = isOpen = true;
        revealPanel = "statistics";
    }
}

void Gui::setRayTracing(bool on) {
    settings.rayTracing = on || !state.canPreview;
}

void Gui::scaleInterface(float change) {
    settings.uiScale = std::clamp(settings.uiScale + change, app::kLeastUiScale, app::kMostUiScale);
}

void Gui::say(const std::string& text, bool isError) {
    toast = text;
    toastTime = ImGui::GetTime();
    toastIsError = isError;
}

} // namespace rt::gui
