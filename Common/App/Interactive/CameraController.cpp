#include "Common/App/Interactive/CameraController.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

namespace rt::app {
namespace {

constexpr double kTraverseSeconds = 3; // to fly from the authored position to the authored target
constexpr double kSteepest = 1.55;     // radians of pitch: short of looking along the vertical
constexpr double kDollyStep = 0.12;    // share of the distance
constexpr double kSpeedStep = 1.25;
constexpr double kFarthest = 1e6; // from the authored position, in authored distances

struct Frame {
    glm::dvec3 right, up, forward;
};

Frame frameOf(const scene::CameraDesc& camera) {
    Frame frame;
    frame.forward = glm::normalize(camera.lookAt - camera.lookFrom);
    frame.right = glm::normalize(glm::cross(frame.forward, camera.up));
    frame.up = glm::cross(frame.right, frame.forward);
    return frame;
}

bool isFinite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Direction from pitch and yaw about `up`.
glm::dvec3 turned(const glm::dvec3& direction, const glm::dvec3& up, double yaw, double pitch) {
    const glm::dvec3 axis = glm::normalize(up);
    const double height = std::clamp(glm::dot(direction, axis), -1.0, 1.0);
    const double newPitch = std::clamp(std::asin(height) + pitch, -kSteepest, kSteepest);
    const glm::dvec3 level = glm::normalize(direction - height * axis);
    const glm::dvec3 side = glm::cross(axis, level);
    const glm::dvec3 heading = std::cos(yaw) * level + std::sin(yaw) * side;
    return std::cos(newPitch) * heading + std::sin(newPitch) * axis;
}

bool isUsable(const scene::CameraDesc& camera) {
    if (!isFinite(camera.lookFrom) || !isFinite(camera.lookAt) || !isFinite(camera.up)) return false;
    const glm::dvec3 view = camera.lookAt - camera.lookFrom;
    const double distance = glm::length(view);
    const double upLength = glm::length(camera.up);
    if (!(distance > 1e-9 && distance < 1e12) || !(upLength > 1e-9 && upLength < 1e9)) return false;
    if (glm::length(glm::cross(view / distance, camera.up / upLength)) < 1e-4) return false;
    return camera.verticalFov > 0.01 && camera.verticalFov < 179 && camera.defocusAngle >= 0 &&
           camera.defocusAngle < 170 && camera.focusDistance > 1e-6 && camera.focusDistance < 1e12;
}

} // namespace

void CameraController::setHome(const scene::CameraDesc& camera) {
    home_ = camera_ = camera;
    speed_ = glm::length(camera.lookAt - camera.lookFrom) / kTraverseSeconds;
}

void CameraController::reset() {
    camera_ = home_;
}

void CameraController::set(const scene::CameraDesc& camera) {
    if (isUsable(camera)) camera_ = camera;
}

void CameraController::move(const glm::dvec3& offset) {
    scene::CameraDesc moved = camera_;
    moved.lookFrom += offset;
    moved.lookAt += offset;
    const double scale = glm::length(home_.lookAt - home_.lookFrom);
    if (glm::length(moved.lookFrom - home_.lookFrom) > kFarthest * scale) return;
    set(moved);
}

void CameraController::fly(double right, double up, double forward, double seconds) {
    const Frame frame = frameOf(camera_);
    move((right * frame.right + up * glm::normalize(camera_.up) + forward * frame.forward) * (speed_ * seconds));
}

void CameraController::look(double yaw, double pitch) {
    const glm::dvec3 view = camera_.lookAt - camera_.lookFrom;
    const double distance = glm::length(view);
    scene::CameraDesc moved = camera_;
    moved.lookAt = camera_.lookFrom + distance * turned(view / distance, camera_.up, yaw, pitch);
    set(moved);
}

void CameraController::orbit(double yaw, double pitch) {
    const glm::dvec3 view = camera_.lookAt - camera_.lookFrom;
    const double distance = glm::length(view);
    scene::CameraDesc moved = camera_;
    moved.lookFrom = camera_.lookAt - distance * turned(view / distance, camera_.up, yaw, pitch);
    set(moved);
}

void CameraController::pan(double right, double up) {
    const Frame frame = frameOf(camera_);
    const double distance = glm::length(camera_.lookAt - camera_.lookFrom);
    const double height = 2 * distance * std::tan(0.5 * camera_.verticalFov * 0.017453292519943295);
    move((right * frame.right + up * frame.up) * height);
}

void CameraController::dolly(double steps) {
    const glm::dvec3 view = camera_.lookAt - camera_.lookFrom;
    const double share = std::pow(1 - kDollyStep, std::clamp(steps, -40.0, 40.0));
    const double home = glm::length(home_.lookAt - home_.lookFrom);
    const double distance = glm::length(view);
    const double wanted = std::clamp(distance * share, 1e-3 * home, kFarthest * home);
    scene::CameraDesc moved = camera_;
    moved.lookFrom = camera_.lookAt - view * (wanted / distance);
    set(moved);
}

void CameraController::frame(const glm::dvec3& center, double radius, double aspect) {
    const double high = 0.5 * camera_.verticalFov * 0.017453292519943295, wide = std::atan(aspect * std::tan(high));
    const double distance = radius / std::sin(std::min(high, wide));
    scene::CameraDesc moved = camera_;
    moved.lookAt = center;
    moved.lookFrom = center - distance * frameOf(camera_).forward;
    moved.focusDistance = distance;
    set(moved);
}

void CameraController::changeSpeed(double steps) {
    const double home = glm::length(home_.lookAt - home_.lookFrom);
    const double factor = std::pow(kSpeedStep, std::clamp(steps, -40.0, 40.0));
    speed_ = std::clamp(speed_ * factor, 1e-4 * home, 1e3 * home);
}

void CameraController::focusAt(double distanceAlongRay, double cosine) {
    scene::CameraDesc focused = camera_;
    focused.focusDistance = distanceAlongRay * cosine;
    set(focused);
}

std::string CameraController::toText(const scene::CameraDesc& camera) {
    const auto vector = [](const glm::dvec3& v) { return nlohmann::ordered_json{v.x, v.y, v.z}; };
    const nlohmann::ordered_json json{{"look_from", vector(camera.lookFrom)},
                                      {"look_at", vector(camera.lookAt)},
                                      {"up", vector(camera.up)},
                                      {"vertical_fov", camera.verticalFov},
                                      {"defocus_angle", camera.defocusAngle},
                                      {"focus_distance", camera.focusDistance}};
    return json.dump();
}

std::optional<scene::CameraDesc> CameraController::fromText(const std::string& text,
                                                            const scene::CameraDesc& defaults) try {
    const nlohmann::json json = nlohmann::json::parse(text);
    if (!json.is_object()) return std::nullopt;
    const nlohmann::json known = nlohmann::json::parse(toText({}));
    for (const auto& [key, value] : json.items())
        if (!known.contains(key)) return std::nullopt;
    scene::CameraDesc camera = defaults;
    const auto vector = [&json](const char* key, glm::dvec3& v) {
        if (json.contains(key)) v = {json.at(key).at(0), json.at(key).at(1), json.at(key).at(2)};
    };
    vector("look_from", camera.lookFrom);
    vector("look_at", camera.lookAt);
    vector("up", camera.up);
    camera.verticalFov = json.value("vertical_fov", camera.verticalFov);
    camera.defocusAngle = json.value("defocus_angle", camera.defocusAngle);
    camera.focusDistance = json.value("focus_distance", camera.focusDistance);
    if (!isUsable(camera)) return std::nullopt;
    return camera;
} catch (const nlohmann::json::exception&) {
    return std::nullopt;
}

} // namespace rt::app
