#include "Common/App/Interactive/ObjectTool.h"

#include <cmath>
#include <cstdio>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "Common/Scene/Edit/ObjectMotion.h"

namespace rt::app {
namespace {

constexpr double kMinScale = 1e-3;
constexpr double kTooSmall = 1e-9; // to divide by

glm::dvec3 unit(int axis) {
    glm::dvec3 vector(0);
    vector[axis] = 1;
    return vector;
}

// How far along the axis through a point the line of sight passes it, where they are not parallel.
std::optional<double> alongAxis(const ViewProjection& view, const glm::dvec3& point, const glm::dvec3& axis,
                                const glm::dvec2& place) {
    const glm::dvec3 sight = glm::normalize(view.direction(place)), between = point - view.eye();
    const double cosine = glm::dot(axis, sight), sine2 = 1 - cosine * cosine;
    if (!(sine2 > 1e-6)) return std::nullopt;
    return (cosine * glm::dot(between, sight) - glm::dot(between, axis)) / sine2;
}

// From the pivot's place to another one, in heights of the picture.
std::optional<glm::dvec2> arm(const ViewProjection& view, const glm::dvec3& pivot, const glm::dvec2& place) {
    const auto middle = view.place(pivot);
    if (!middle) return std::nullopt;
    const glm::dvec2 offset = place - *middle;
    return glm::dvec2(offset.x * view.aspect(), offset.y);
}

} // namespace

std::optional<scene::Transform> ObjectTool::steps(const ViewProjection& view, const glm::dvec2& place) const {
    if (place == start_) return std::nullopt;
    switch (kind_) {
        case Kind::Move:
            return move(view, place);
        case Kind::Turn:
            return turn(view, place);
        case Kind::Scale:
            break;
    }
    return scale(view, place);
}

std::optional<scene::Transform> ObjectTool::move(const ViewProjection& view, const glm::dvec2& place) const {
    if (!view.place(pivot_)) return std::nullopt;
    if (!axis_) {
        const glm::dvec3 offset = view.inPlaneOf(pivot_, place) - view.inPlaneOf(pivot_, start_);
        return scene::Transform{scene::Translate{offset}};
    }
    const auto from = alongAxis(view, pivot_, unit(*axis_), start_), to = alongAxis(view, pivot_, unit(*axis_), place);
    if (!from || !to) return std::nullopt;
    return scene::Transform{scene::Translate{(*to - *from) * unit(*axis_)}};
}

// By the angle that the pointer goes through about the pivot, as seen.
std::optional<scene::Transform> ObjectTool::turn(const ViewProjection& view, const glm::dvec2& place) const {
    const auto from = arm(view, pivot_, start_), to = arm(view, pivot_, place);
    if (!from || !to || !(glm::length(*from) > kTooSmall && glm::length(*to) > kTooSmall)) return std::nullopt;
    // Counter-clockwise as seen; the picture's second axis points down.
    const double angle = std::atan2(from->y * to->x - from->x * to->y, glm::dot(*from, *to));
    const glm::dvec3 towardsEye = -view.forward();
    const glm::dvec3 axis = axis_ ? unit(*axis_) : towardsEye;
    const double sense = glm::dot(axis, view.eye() - pivot_) < 0 ? -1 : 1; // of an axis that points away
    return scene::turned(pivot_, axis, sense * glm::degrees(angle));
}

std::optional<scene::Transform> ObjectTool::scale(const ViewProjection& view, const glm::dvec2& place) const {
    const auto from = arm(view, pivot_, start_), to = arm(view, pivot_, place);
    if (!from || !to || !(glm::length(*from) > kTooSmall)) return std::nullopt;
    const double factor = std::fmax(kMinScale, glm::length(*to) / glm::length(*from));
    glm::dvec3 factors(factor);
    if (axis_) factors = glm::dvec3(1) + (factor - 1) * unit(*axis_);
    return scene::scaled(pivot_, factors);
}

std::string ObjectTool::text(const scene::Transform& steps) const {
    constexpr const char* kAxes[] = {"X", "Y", "Z"};
    const std::string axis = axis_ ? kAxes[*axis_] : "";
    char text[96];
    if (kind_ == Kind::Move) {
        const glm::dvec3 o = std::get<scene::Translate>(steps.front()).offset;
        std::snprintf(text, sizeof text, ": %.4g, %.4g, %.4g", o.x, o.y, o.z);
        return (axis_ ? "Move along " + axis : "Move") + text;
    }
    if (kind_ == Kind::Turn) {
        std::snprintf(text, sizeof text, ": %.1f degrees", std::get<scene::Rotate>(steps[1]).degrees);
        return (axis_ ? "Turn about " + axis : "Turn") + text;
    }
    const glm::dvec3 f = std::get<scene::Scale>(steps[1]).factors;
    std::snprintf(text, sizeof text, ": %.4g, %.4g, %.4g", f.x, f.y, f.z);
    return (axis_ ? "Scale along " + axis : "Scale") + text;
}

} // namespace rt::app
