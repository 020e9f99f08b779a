#include "Common/App/Interactive/ObjectTool.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "Common/Core/Format.h"
#include "Common/Scene/Edit/ObjectMotion.h"

namespace rt::app {
namespace {

constexpr double kMinScale = 1e-3;
constexpr double kTooSmall = 1e-9; // to divide by
constexpr double kTurnStep = 15;   // degrees
constexpr double kScaleSteps = 10; // of 1
constexpr double kStepShare = 25;  // steps of a move, at least, in the height of the picture
constexpr double kFlatRing = 0.25; // cosine between its axis and the sight, below which it is seen as a line

constexpr const char* kAxisNames[] = {"X", "Y", "Z"};
constexpr const char* kPlaneNames[] = {"Y and Z", "X and Z", "X and Y"}; // across each axis

// From the pivot's place to another one, in heights of the picture.
std::optional<glm::dvec2> arm(const ViewProjection& view, const glm::dvec3& pivot, const glm::dvec2& place) {
    const auto middle = view.place(pivot);
    if (!middle) return std::nullopt;
    const glm::dvec2 offset = place - *middle;
    return glm::dvec2(offset.x * view.aspect(), offset.y);
}

// Fractions of 1 as the decimal number that they are; 0 without a sign.
double toStep(double value, double step) {
    const double count = std::round(value / step) + 0.0;
    return step < 1 ? count / std::round(1 / step) : count * step;
}

std::string threeNumbers(const glm::dvec3& v) {
    return formatted(": %.4g, %.4g, %.4g", v.x, v.y, v.z);
}

} // namespace

std::optional<double> alongAxis(const ViewProjection& view, const glm::dvec3& point, const glm::dvec3& axis,
                                const glm::dvec2& place) {
    const glm::dvec3 sight = glm::normalize(view.direction(place)), between = point - view.eye();
    const double cosine = glm::dot(axis, sight), sine2 = 1 - cosine * cosine;
    if (!(sine2 > 1e-6)) return std::nullopt;
    return (cosine * glm::dot(between, sight) - glm::dot(between, axis)) / sine2;
}

std::optional<glm::dvec3> inPlane(const ViewProjection& view, const glm::dvec3& point, const glm::dvec3& normal,
                                  const glm::dvec2& place) {
    const glm::dvec3 sight = glm::normalize(view.direction(place));
    const double cosine = glm::dot(sight, normal), distance = glm::dot(point - view.eye(), normal) / cosine;
    if (!(std::abs(cosine) > 1e-3 && distance > 0)) return std::nullopt;
    return view.eye() + distance * sight;
}

void ObjectTool::constrain(int axis) {
    const Constraint wanted{axis, false};
    constraint_ = constraint_ == wanted ? std::nullopt : std::optional(wanted);
}

double ObjectTool::moveStep(const ViewProjection& view) const {
    const double most = view.heightAt(axes_.pivot) / kStepShare;
    const double power = std::pow(10, std::floor(std::log10(most)));
    for (const double factor : {5.0, 2.0})
        if (factor * power <= most) return factor * power;
    return power;
}

std::optional<ObjectTool::Motion> ObjectTool::motion(const ViewProjection& view, const glm::dvec2& place,
                                                     bool isSnapped) const {
    if (place == start_ || !view.place(axes_.pivot)) return std::nullopt;
    switch (kind_) {
        case Kind::Move:
            return move(view, place, isSnapped);
        case Kind::Turn:
            return turn(view, place, isSnapped);
        case Kind::Scale:
            break;
    }
    return scale(view, place, isSnapped);
}

// "Move along X"
std::string ObjectTool::textOf(const char* verb, const char* preposition) const {
    if (!constraint_) return verb;
    const auto& names = constraint_->isPlane ? kPlaneNames : kAxisNames;
    return std::string(verb) + ' ' + preposition + ' ' + names[constraint_->axis];
}

std::optional<ObjectTool::Motion> ObjectTool::move(const ViewProjection& view, const glm::dvec2& place,
                                                   bool isSnapped) const {
    const bool isLine = constraint_ && !constraint_->isPlane;
    glm::dvec3 way(0); // along the axes
    if (!constraint_) {
        const glm::dvec3 offset = view.inPlaneOf(axes_.pivot, place) - view.inPlaneOf(axes_.pivot, start_);
        way = glm::transpose(axes_.directions) * offset;
    } else if (isLine) {
        const glm::dvec3& axis = axes_.directions[constraint_->axis];
        const auto from = alongAxis(view, axes_.pivot, axis, start_), to = alongAxis(view, axes_.pivot, axis, place);
        if (!from || !to) return std::nullopt;
        way[constraint_->axis] = *to - *from;
    } else {
        const glm::dvec3& normal = axes_.directions[constraint_->axis];
        const auto from = inPlane(view, axes_.pivot, normal, start_), to = inPlane(view, axes_.pivot, normal, place);
        if (!from || !to) return std::nullopt;
        way = glm::transpose(axes_.directions) * (*to - *from);
        way[constraint_->axis] = 0;
    }
    const double step = moveStep(view);
    for (int i = 0; i < 3 && isSnapped; ++i) way[i] = toStep(way[i], step);
    std::string text = textOf("Move", "along");
    text += isLine ? formatted(": %.4g", way[constraint_->axis]) : threeNumbers(way);
    if (isSnapped) text += formatted(" by steps of %.4g", step);
    return Motion{{scene::Translate{axes_.directions * way}}, std::move(text)};
}

// By the angle that the pointer goes through about the pivot, as seen: counter-clockwise is positive, and the picture's
// second axis points down.
std::optional<double> ObjectTool::turnedBy(const ViewProjection& view, const glm::dvec2& place) const {
    const auto from = arm(view, axes_.pivot, start_), to = arm(view, axes_.pivot, place);
    if (!from || !to || !(glm::length(*from) > kTooSmall && glm::length(*to) > kTooSmall)) return std::nullopt;
    return std::atan2(from->y * to->x - from->x * to->y, glm::dot(*from, *to));
}

// In the ring's plane; where that is seen from its edge, by the way along the edge.
std::optional<double> ObjectTool::ringAngle(const ViewProjection& view, const glm::dvec2& place) const {
    const glm::dvec3 axis = axes_.directions[constraint_->axis], toEye = glm::normalize(view.eye() - axes_.pivot);
    if (std::abs(glm::dot(axis, toEye)) < kFlatRing) {
        const glm::dvec3 edge = glm::normalize(glm::cross(axis, toEye));
        const glm::dvec3 way = view.inPlaneOf(axes_.pivot, place) - view.inPlaneOf(axes_.pivot, start_);
        return glm::dot(way, edge) / reach_;
    }
    const auto from = inPlane(view, axes_.pivot, axis, start_), to = inPlane(view, axes_.pivot, axis, place);
    if (!from || !to) return std::nullopt;
    const glm::dvec3 a = *from - axes_.pivot, b = *to - axes_.pivot;
    if (!(glm::length(a) > kTooSmall * reach_ && glm::length(b) > kTooSmall * reach_)) return std::nullopt;
    return std::atan2(glm::dot(axis, glm::cross(a, b)), glm::dot(a, b));
}

std::optional<ObjectTool::Motion> ObjectTool::turn(const ViewProjection& view, const glm::dvec2& place,
                                                   bool isSnapped) const {
    const glm::dvec3 axis = constraint_ ? axes_.directions[constraint_->axis] : -view.forward();
    const bool isRing = constraint_ && reach_ > 0;
    const auto angle = isRing ? ringAngle(view, place) : turnedBy(view, place);
    if (!angle) return std::nullopt;
    const bool pointsAway = !isRing && glm::dot(axis, view.eye() - axes_.pivot) < 0;
    double degrees = (pointsAway ? -1 : 1) * glm::degrees(*angle);
    if (isSnapped) degrees = toStep(degrees, kTurnStep);
    return Motion{scene::turned(axes_.pivot, axis, degrees),
                  textOf("Turn", "about") + formatted(": %.1f degrees", degrees)};
}

std::optional<ObjectTool::Motion> ObjectTool::scale(const ViewProjection& view, const glm::dvec2& place,
                                                    bool isSnapped) const {
    const bool isArm = reach_ > 0 && constraint_ && !constraint_->isPlane;
    double factor = 1;
    if (isArm) { // whose end stays under the pointer
        const glm::dvec3& axis = axes_.directions[constraint_->axis];
        const auto from = alongAxis(view, axes_.pivot, axis, start_), to = alongAxis(view, axes_.pivot, axis, place);
        if (!from || !to || !(std::abs(*from) > kTooSmall * reach_)) return std::nullopt;
        factor = *to / *from;
    } else {
        const auto from = arm(view, axes_.pivot, start_), to = arm(view, axes_.pivot, place);
        if (!from || !to || !(glm::length(*from) > kTooSmall)) return std::nullopt;
        factor = glm::length(*to) / glm::length(*from);
    }
    factor = std::fmax(kMinScale, factor);
    if (isSnapped) factor = std::fmax(1, std::round(kScaleSteps * factor)) / kScaleSteps;
    glm::dvec3 factors(factor);
    for (int i = 0; i < 3 && constraint_; ++i)
        if ((i == constraint_->axis) == constraint_->isPlane) factors[i] = 1;
    return Motion{scene::scaled(axes_.pivot, factors, axes_.directions),
                  textOf("Scale", "along") + threeNumbers(factors)};
}

} // namespace rt::app
