#include "Common/App/Interactive/ViewProjection.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace rt::app {

ViewProjection::ViewProjection(const scene::CameraDesc& camera, double aspect)
    : eye_(camera.lookFrom), forward_(glm::normalize(camera.lookAt - camera.lookFrom)) {
    right_ = glm::normalize(glm::cross(forward_, camera.up));
    up_ = glm::cross(right_, forward_);
    halfHeight_ = std::tan(0.5 * glm::radians(camera.verticalFov));
    halfWidth_ = halfHeight_ * aspect;
    nearest_ = 1e-6 * glm::length(camera.lookAt - camera.lookFrom);
}

double ViewProjection::depth(const glm::dvec3& point) const {
    return glm::dot(point - eye_, forward_);
}

std::optional<glm::dvec2> ViewProjection::place(const glm::dvec3& point) const {
    const double z = depth(point);
    if (!(z >= nearest_)) return std::nullopt;
    const glm::dvec3 seen = (point - eye_) / z;
    return glm::dvec2(0.5 + 0.5 * glm::dot(seen, right_) / halfWidth_, 0.5 - 0.5 * glm::dot(seen, up_) / halfHeight_);
}

std::optional<std::pair<glm::dvec2, glm::dvec2>> ViewProjection::line(glm::dvec3 a, glm::dvec3 b) const {
    const double za = depth(a), zb = depth(b);
    if (!(za >= nearest_ || zb >= nearest_)) return std::nullopt;
    const double front = 2 * nearest_; // rounding leaves it in front
    if (za < front && zb > front) a += (front - za) / (zb - za) * (b - a);
    if (zb < front && za > front) b += (front - zb) / (za - zb) * (a - b);
    const auto from = place(a), to = place(b);
    if (!from || !to) return std::nullopt;
    return std::pair(*from, *to);
}

glm::dvec3 ViewProjection::direction(const glm::dvec2& place) const {
    return forward_ + (2 * place.x - 1) * halfWidth_ * right_ + (1 - 2 * place.y) * halfHeight_ * up_;
}

glm::dvec3 ViewProjection::inPlaneOf(const glm::dvec3& point, const glm::dvec2& place) const {
    return eye_ + depth(point) * direction(place);
}

} // namespace rt::app
