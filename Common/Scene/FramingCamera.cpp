#include "Common/Scene/FramingCamera.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "Common/Scene/Json/JsonNode.h"

namespace rt::scene {

CameraDesc framingCamera(const Bounds& bounds) {
    // Whatever they are, the camera is one that a scene file may have, and its view is not lost to rounding.
    const glm::dvec3 center = glm::clamp(bounds.center(), -kLargest / 2, kLargest / 2);
    const double minimum = std::max(1 / kLargest, 1e-7 * glm::length(center));
    const double radius = std::clamp(bounds.radius(), minimum, kLargest / 10);
    CameraDesc camera;
    camera.verticalFov = 40;
    camera.focusDistance = 1.05 * radius / std::sin(glm::radians(camera.verticalFov) / 2);
    camera.lookAt = center;
    camera.lookFrom = camera.lookAt + camera.focusDistance * glm::normalize(glm::dvec3(0.5, 0.35, 1));
    return camera;
}

} // namespace rt::scene
