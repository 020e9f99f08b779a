#include "Common/Scene/CameraRecord.h"

#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>

#include "Common/Core/Error.h"

namespace rt::scene {

namespace {

double radians(double degrees) {
    return degrees * std::numbers::pi / 180.0;
}

// Negated comparisons refuse NaN too.
void check(const CameraDesc& desc) {
    if (!(desc.verticalFov > 0.0 && desc.verticalFov < 180.0)) {
        throw InputError("camera: vertical field of view " + std::to_string(desc.verticalFov) +
                         " is not between 0 and 180 degrees");
    }
    if (!(desc.focusDistance > 0.0 && std::isfinite(desc.focusDistance))) {
        throw InputError("camera: focus distance " + std::to_string(desc.focusDistance) + " is not positive");
    }
    if (!(desc.defocusAngle >= 0.0 && desc.defocusAngle < 180.0)) {
        throw InputError("camera: defocus angle " + std::to_string(desc.defocusAngle) +
                         " is not between 0 and 180 degrees");
    }
}

} // namespace

shared::Camera makeCamera(const CameraDesc& desc, std::uint32_t width, std::uint32_t height, const glm::dvec3& origin) {
    check(desc);
    // Right-handed: u to the right of the image, v up, w backwards.
    const glm::dvec3 backwards = desc.lookFrom - desc.lookAt;
    const glm::dvec3 sideways = glm::cross(desc.up, backwards);
    const double size = glm::length(desc.up) * glm::length(backwards);
    if (!(size > 0.0 && std::isfinite(size) && glm::length(sideways) > 1e-9 * size)) {
        throw InputError("camera: the view from lookFrom to lookAt must have a length and not be parallel to up");
    }
    const glm::dvec3 w = glm::normalize(backwards);
    const glm::dvec3 u = glm::normalize(sideways);
    const glm::dvec3 v = glm::cross(w, u);

    const double imageHeight = 2.0 * std::tan(radians(desc.verticalFov) / 2.0) * desc.focusDistance;
    const glm::dvec3 across = imageHeight * (double(width) / double(height)) * u;
    const glm::dvec3 down = -imageHeight * v;
    const double lensRadius = desc.focusDistance * std::tan(radians(desc.defocusAngle) / 2.0);

    shared::Camera camera;
    camera.origin = desc.lookFrom - origin;
    camera.corner = -desc.focusDistance * w - 0.5 * (across + down);
    camera.across = across;
    camera.down = down;
    camera.lensU = lensRadius * u;
    camera.lensV = lensRadius * v;
    return camera;
}

} // namespace rt::scene
