#include "Common/Scene/Pbrt/PbrtCamera.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "Common/Core/Printable.h"
#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/Placing.h"
#include "Common/Scene/Studio.h"

namespace rt::scene {

namespace {

constexpr const char* kCameras = "perspective, orthographic, realistic, spherical";

constexpr double kFarthest = kLargest / 4; // that a camera looks

// Half the height of the screen, whose shorter side goes from -1 to 1 unless the file says otherwise.
double halfHeight(const PbrtView& view, PbrtNotices& notices) {
    const double aspect = view.camera.number("frameaspectratio", view.aspect, 1 / kLargest, kLargest);
    const PbrtParameter* window = view.camera.find("screenwindow", PbrtType::Number);
    if (!window) return aspect >= 1 ? 1 : 1 / aspect;
    const std::vector<double>& sides = window->numbers; // left, right, bottom, top
    if (sides.size() != 4 || !(sides[0] < sides[1] && sides[2] < sides[3]))
        window->fail("must be left, right, bottom and top, each pair growing");
    for (const double side : sides) pbrtFinite(*window, side);
    if (sides[0] != -sides[1] || sides[2] != -sides[3])
        notices.add("screen windows are moved to the middle of the view", window->place);
    return 0.5 * (sides[3] - sides[2]);
}

} // namespace

void PbrtView::setFilm(PbrtParameters parameters, PbrtNotices& notices) {
    const int width = parameters.integer("xresolution", 1280), height = parameters.integer("yresolution", 720);
    if (width < 1 || height < 1) parameters.fail("\"xresolution\" and \"yresolution\" must be 1 or more");
    aspect = double(width) / height;
    for (const char* name : {"cropwindow", "pixelbounds"})
        if (parameters.has(name))
            notices.add("the crop of the film is left out: --region renders a part", parameters.place);
    const double exposure = parameters.number("iso", 100) / 100 * parameters.number("exposuretime", 1);
    if (exposure > 0 && exposure != 1)
        notices.add("iso and exposure time of the film are left out: --exposure " +
                        std::to_string(std::log2(exposure)) + " stands for them",
                    parameters.place);
    if (const std::string sensor = parameters.string("sensor", "cie1931"); sensor != "cie1931")
        notices.add("the film's sensor \"" + printable(sensor, 100) + "\" is left out", parameters.place);
    for (const char* usual : {"filename", "diagonal", "savefp16", "maxcomponentvalue"}) parameters.find(usual);
    notices.addUnused(parameters);
    film = std::move(parameters);
}

void setPbrtCamera(const PbrtView& view, const Affine& toScene, SceneDesc& scene, PbrtNotices& notices) {
    const Bounds bounds = boundsOfMeshes(scene);
    scene.render.aspect = std::clamp(view.aspect, 1 / kLargest, kLargest);
    const std::optional<Affine> toWorld = inverse(view.fromWorld);
    if (!toWorld) view.camera.fail("its transform cannot be inverted");
    const Affine place = toScene * *toWorld;
    CameraDesc camera;
    camera.lookFrom = place.offset;
    const glm::dvec3 forward = place.vector({0, 0, 1}), up = place.vector({0, 1, 0});
    const double scale = glm::length(forward);
    const bool isUsable = isWithinLimits({place.linear, 2.0 * place.offset}) && scale >= 1 / kLargest &&
                          glm::length(glm::cross(forward, up)) > 1e-9 * scale * glm::length(up);
    if (!isUsable) view.camera.fail("its transform, turned around, exceeds 1e9 or leaves it no direction");
    camera.up = glm::normalize(up);
    // What it looks at is turned around in a window.
    const double distance = glm::dot(bounds.center() - camera.lookFrom, forward / scale);
    camera.focusDistance =
        !bounds.empty() && distance > 1e-6 * bounds.radius() && distance > 1e-6 ? std::min(distance, kFarthest) : 1;

    double half = halfHeight(view, notices);
    if (view.kind == "orthographic") {
        half *= glm::length(up) / camera.focusDistance;
        notices.add("the camera is orthographic: seen in perspective, which shows as much at the scene's middle",
                    view.camera.place);
    } else if (view.kind == "perspective") {
        half *= std::tan(glm::radians(view.camera.number("fov", 90, 1e-6, 179.999)) / 2);
    } else if (view.kind == "realistic" || view.kind == "spherical") {
        for (const char* name : {"lensfile", "aperturediameter", "focusdistance", "aperture", "mapping"})
            view.camera.find(name);
        notices.add("a " + view.kind + " camera is seen in perspective", view.camera.place);
        half *= view.kind == "realistic" ? std::tan(glm::radians(20.0)) : 1;
    } else {
        view.camera.fail("the camera is unknown; known are " + std::string(kCameras));
    }
    camera.verticalFov = std::clamp(2 * glm::degrees(std::atan(half)), 1e-6, 179.999);
    const double lens = view.camera.number("lensradius", 0, 0, kLargest) * scale;
    const double focus = view.camera.number("focaldistance", 1e6, 1 / kLargest, kLargest) * scale;
    if (lens > 0) {
        camera.focusDistance = std::clamp(focus, 1 / kLargest, kFarthest);
        camera.defocusAngle = std::min(2 * glm::degrees(std::atan(lens / camera.focusDistance)), 179.999);
    }
    camera.lookAt = camera.lookFrom + camera.focusDistance * (forward / scale);
    for (const char* time : {"shutteropen", "shutterclose"}) view.camera.find(time);
    notices.addUnused(view.camera);
    scene.camera = camera;
}

} // namespace rt::scene
