#include "Common/Scene/FramingCamera.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace rt::scene {

CameraDesc framingCamera(const Bounds& bounds) {
    const double radius = std::max(bounds.radius(), 1e-12);
    CameraDesc camera;
    camera.verticalFov = 40;
    camera.focusDistance = 1.05 * radius / std::sin(glm::radians(camera.verticalFov) / 2);
    camera.lookAt = bounds.center();
    camera.lookFrom = camera.lookAt + camera.focusDistance * glm::normalize(glm::dvec3(0.5, 0.35, 1));
    return camera;
}

} // namespace rt::scene
