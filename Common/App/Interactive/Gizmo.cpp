#include "Common/App/Interactive/Gizmo.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

namespace rt::app {
namespace {

constexpr double kArmBegin = 0.18;                      // of an arm's length, where it leaves the middle's circle
constexpr double kSquareBegin = 0.3, kSquareEnd = 0.52; // of planes, along both axes
constexpr double kMiddleRadius = 0.12, kTurnRadius = 1.18, kScaleRadius = 1.22; // of circles across the view
constexpr double kLetterPlace = 1.16;
constexpr double kShortestArm = 0.15;   // arm, as seen, of its length
constexpr double kFlattestPlane = 0.15; // plane: cosine between its normal and the sight
constexpr double kHalfDepth = -0.15;    // of rings, of their radius: what is behind that is hidden
constexpr int kSegments = 64;

class Builder {
  public:
    Builder(const ToolAxes& axes, const ViewProjection& view, double size)
        : axes_(axes),
          view_(view),
          size_(size),
          reach_(size * view.heightAt(axes.pivot)),
          toEye_(glm::normalize(view.eye() - axes.pivot)),
          middle_(view.place(axes.pivot)) {}

    std::vector<GizmoHandle> build(ObjectTool::Kind kind) {
        if (!middle_) return {};
        for (int axis = 0; axis < 3; ++axis) kind == ObjectTool::Kind::Turn ? addRing(axis) : addArm(axis);
        for (int axis = 0; axis < 3 && kind != ObjectTool::Kind::Turn; ++axis) addSquare(axis);
        addCircle(kind == ObjectTool::Kind::Move   ? kMiddleRadius
                  : kind == ObjectTool::Kind::Turn ? kTurnRadius
                                                   : kScaleRadius);
        return std::move(handles_);
    }

  private:
    glm::dvec3 at(const glm::dvec3& offset) const { return axes_.pivot + reach_ * offset; }
    const glm::dvec3& direction(int axis) const { return axes_.directions[axis % 3]; }
    double seenLength(const GizmoHandle::Line& line) const {
        const glm::dvec2 way = line.second - line.first;
        return glm::length(glm::dvec2(way.x * view_.aspect(), way.y));
    }

    void addArm(int axis) {
        const glm::dvec3& d = direction(axis);
        const auto line = view_.line(at(kArmBegin * d), at(d));
        if (!line || seenLength(*line) < kShortestArm * size_) return;
        handles_.push_back({ObjectTool::Constraint{axis, false}, {*line}, {}, line, view_.place(at(kLetterPlace * d))});
    }

    void addSquare(int axis) {
        const glm::dvec3 &u = direction(axis + 1), &v = direction(axis + 2);
        if (std::abs(glm::dot(direction(axis), toEye_)) < kFlattestPlane) return;
        GizmoHandle handle{ObjectTool::Constraint{axis, true}, {}};
        constexpr double a = kSquareBegin, b = kSquareEnd;
        for (const glm::dvec3& corner : {a * u + a * v, b * u + a * v, b * u + b * v, a * u + b * v})
            if (const auto place = view_.place(at(corner))) handle.area.push_back(*place);
        if (handle.area.size() == 4) handles_.push_back(std::move(handle));
    }

    // The half that is in front; all of one that faces the eye.
    void addRing(int axis) {
        const glm::dvec3 &u = direction(axis + 1), &v = direction(axis + 2);
        GizmoHandle handle{ObjectTool::Constraint{axis, false}, {}};
        const auto point = [&](int i) {
            const double angle = 2 * std::numbers::pi * i / kSegments;
            return std::cos(angle) * u + std::sin(angle) * v;
        };
        for (int i = 0; i < kSegments; ++i) {
            const glm::dvec3 from = point(i), to = point(i + 1);
            if (std::min(glm::dot(from, toEye_), glm::dot(to, toEye_)) < kHalfDepth) continue;
            if (const auto line = view_.line(at(from), at(to))) handle.lines.push_back(*line);
        }
        // Where the ring goes behind: letters are apart there.
        const glm::dvec3 end = glm::cross(direction(axis), toEye_);
        const bool isFacing = glm::length(end) < kShortestArm;
        handle.letter = view_.place(at(kLetterPlace * glm::normalize(isFacing ? u + v : end)));
        handles_.push_back(std::move(handle));
    }

    void addCircle(double radius) {
        GizmoHandle handle;
        const auto point = [&](int i) {
            const double angle = 2 * std::numbers::pi * i / kSegments;
            return *middle_ + radius * size_ * glm::dvec2(std::cos(angle) / view_.aspect(), std::sin(angle));
        };
        for (int i = 0; i < kSegments; ++i) handle.lines.emplace_back(point(i), point(i + 1));
        handles_.push_back(std::move(handle));
    }

    const ToolAxes& axes_;
    const ViewProjection& view_;
    double size_, reach_;
    glm::dvec3 toEye_;
    std::optional<glm::dvec2> middle_;
    std::vector<GizmoHandle> handles_;
};

double distanceTo(const GizmoHandle::Line& line, const glm::dvec2& place) {
    const glm::dvec2 way = line.second - line.first, offset = place - line.first;
    const double length2 = glm::dot(way, way);
    const double share = length2 > 0 ? std::clamp(glm::dot(offset, way) / length2, 0.0, 1.0) : 0;
    return glm::length(offset - share * way);
}

// Convex, of either sense.
bool isInArea(const std::vector<glm::dvec2>& area, const glm::dvec2& place) {
    int left = 0, right = 0;
    for (std::size_t i = 0; i < area.size(); ++i) {
        const glm::dvec2 &a = area[i], &b = area[(i + 1) % area.size()];
        const double side = (b.x - a.x) * (place.y - a.y) - (b.y - a.y) * (place.x - a.x);
        ++(side > 0 ? left : right);
    }
    return !area.empty() && (left == 0 || right == 0);
}

} // namespace

std::vector<GizmoHandle> gizmoHandles(ObjectTool::Kind kind, const ToolAxes& axes, const ViewProjection& view,
                                      double size) {
    return Builder(axes, view, size).build(kind);
}

const GizmoHandle* handleAt(const std::vector<GizmoHandle>& handles, double aspect, const glm::dvec2& place,
                            double distance) {
    const auto inHeights = [aspect](const glm::dvec2& p) { return glm::dvec2(p.x * aspect, p.y); };
    const GizmoHandle* nearest = nullptr;
    const double inside = 0.5 * distance; // lines that cross an area win
    for (const GizmoHandle& handle : handles) {
        double own = isInArea(handle.area, place) ? inside : std::numeric_limits<double>::infinity();
        for (const auto& [from, to] : handle.lines)
            own = std::min(own, distanceTo({inHeights(from), inHeights(to)}, inHeights(place)));
        if (own > distance) continue;
        distance = own;
        nearest = &handle;
    }
    return nearest;
}

} // namespace rt::app
