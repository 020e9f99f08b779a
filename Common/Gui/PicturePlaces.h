// From places of the picture, as ViewProjection has them, to the window's units and back.
#pragma once
#include <algorithm>

#include <imgui.h>

#include "Common/App/Interactive/ViewProjection.h"
#include "Common/Gui/Gui.h"
#include "Common/Gui/Layout.h"

namespace rt::gui {

inline app::ViewProjection projectionOf(const Gui& gui, const scene::CameraDesc& camera) {
    const app::RenderSettings& settings = gui.state.settings;
    return {camera, static_cast<double>(settings.width) / std::max(1u, settings.height)};
}
inline app::ViewProjection projectionOf(const Gui& gui) {
    return projectionOf(gui, gui.camera.camera());
}

inline ImVec2 inWindow(const glm::dvec2& place, const Rect& image) {
    return {image.x + static_cast<float>(place.x) * image.width, image.y + static_cast<float>(place.y) * image.height};
}

inline glm::dvec2 placeInPicture(const ImVec2& point, const Rect& image) {
    return {(point.x - image.x) / std::max(1.0f, image.width), (point.y - image.y) / std::max(1.0f, image.height)};
}

} // namespace rt::gui
