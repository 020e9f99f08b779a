#include "Common/Scene/Gltf/GltfCameras.h"

#include <cmath>
#include <cstddef>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "Common/Scene/FramingCamera.h"
#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/UniqueNames.h"

namespace rt::scene {

namespace {

// Degrees, of what is in view at `distance` where nothing says more.
double verticalFov(const GltfFile& file, std::size_t number, double distance) {
    const tinygltf::Camera& source = file.model.cameras[number];
    const std::string place = "/cameras/" + std::to_string(number);
    if (source.type == "perspective") {
        const double fov = glm::degrees(source.perspective.yfov);
        if (!(fov > 0 && fov < 180)) file.fail(place + "/perspective/yfov", "must be between 0 and pi");
        return fov;
    }
    const double half = std::abs(source.orthographic.ymag);
    const double fov = 2 * glm::degrees(std::atan(half / distance));
    if (!(half <= kLargest && fov > 0 && fov < 180))
        file.fail(place + "/orthographic/ymag", "must be from -1e9 to 1e9 and not 0");
    return fov;
}

double aspectOf(const tinygltf::Camera& source) {
    if (source.type == "perspective") return source.perspective.aspectRatio;
    return std::abs(source.orthographic.xmag / source.orthographic.ymag);
}

// Where a node puts a camera; what it looks at is turned around in a window: as far away as the scene's middle. None
// where the transform leaves it no direction.
std::optional<CameraDesc> cameraAt(const GltfNodes::Placed& placed, const Bounds& bounds) {
    CameraDesc camera;
    camera.lookFrom = placed.toWorld.offset;
    const glm::dvec3 view = placed.toWorld.vector({0, 0, -1}), up = placed.toWorld.vector({0, 1, 0});
    if (!(glm::length(glm::cross(view, up)) > 1e-9 * glm::length(view) * glm::length(up))) return std::nullopt;
    const glm::dvec3 direction = glm::normalize(view);
    camera.up = glm::normalize(up);
    const double distance = glm::dot(bounds.center() - camera.lookFrom, direction);
    camera.focusDistance = distance > 1e-6 * bounds.radius() && distance > 1e-6 ? distance : 1;
    camera.lookAt = camera.lookFrom + camera.focusDistance * direction;
    return camera;
}

} // namespace

void addCameras(const GltfFile& file, const GltfNodes& nodes, const GltfStart& start, SceneDesc& scene) {
    UniqueNames names;
    bool isFirst = true;
    scene.camera = framingCamera(start.bounds);
    for (const GltfNodes::Placed& placed : nodes.placed()) {
        const tinygltf::Node& node = file.model.nodes[placed.node];
        if (node.camera < 0) continue;
        const auto number = static_cast<std::size_t>(node.camera);
        const tinygltf::Camera& source = file.model.cameras[number];
        const std::string name = names.unique(source.name.empty() ? node.name : source.name, "camera", number);
        const auto noteThat = [&](const char* what) { scene.notices.push_back("camera \"" + name + "\" " + what); };
        std::optional<CameraDesc> camera = cameraAt(placed, start.bounds);
        if (camera) {
            camera->verticalFov = verticalFov(file, number, camera->focusDistance);
        } else {
            const auto atStart = start.cameras.find(name);
            noteThat(atStart != start.cameras.end()
                         ? "stays where it was at the start: the transform of its node leaves it no direction"
                         : "is left out: the transform of its node leaves it no direction");
            if (atStart == start.cameras.end()) continue;
            camera = atStart->second;
        }
        if (source.type != "perspective")
            noteThat("is orthographic: seen in perspective, which shows as much at the scene's middle");
        if (placed.toWorld.mirrors())
            noteThat("is mirrored by its node: what it sees is not, as scaling is no part of a view");
        if (isFirst) {
            scene.camera = *camera;
            const double aspect = aspectOf(source);
            if (aspect > 1 / kLargest && aspect < kLargest) scene.render.aspect = aspect;
        }
        isFirst = false;
        scene.cameras[name] = *camera;
    }
}

} // namespace rt::scene
