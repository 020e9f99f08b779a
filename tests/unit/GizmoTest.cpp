// The handles over the picture: of one size wherever they are, taken where they are seen, left out where they are not.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "Common/App/Interactive/Gizmo.h"
#include "tests/unit/CompilerScenes.h"

namespace rt::app {
namespace {

constexpr double kAspect = 1.5, kSize = 0.2; // of the picture's height
constexpr ObjectTool::Kind kKinds[] = {ObjectTool::Kind::Move, ObjectTool::Kind::Turn, ObjectTool::Kind::Scale};

ViewProjection viewFrom(const glm::dvec3& eye, const glm::dvec3& target = glm::dvec3(0)) {
    scene::CameraDesc camera;
    camera.lookFrom = eye;
    camera.lookAt = target;
    camera.verticalFov = 40;
    return {camera, kAspect};
}

const GizmoHandle* find(const std::vector<GizmoHandle>& handles, std::optional<ObjectTool::Constraint> constraint) {
    const auto is = [&](const GizmoHandle& handle) { return handle.constraint == constraint; };
    const auto at = std::find_if(handles.begin(), handles.end(), is);
    return at == handles.end() ? nullptr : &*at;
}

glm::dvec2 inHeights(const glm::dvec2& place) {
    return {place.x * kAspect, place.y};
}

double lengthOf(const GizmoHandle::Line& line) {
    return glm::length(inHeights(line.second) - inHeights(line.first));
}

TEST(Gizmo, IsOfOneSizeHoweverFarAway) {
    for (const double distance : {0.01, 3.0, 2000.0}) {
        const ViewProjection view = viewFrom({0.0, 0.0, distance});
        for (const auto kind : {ObjectTool::Kind::Move, ObjectTool::Kind::Scale}) {
            const auto handles = gizmoHandles(kind, {}, view, kSize);
            for (const int axis : {0, 1}) {
                const GizmoHandle* arm = find(handles, ObjectTool::Constraint{axis, false});
                ASSERT_NE(arm, nullptr);
                const glm::dvec2 end = inHeights(arm->arm->second) - inHeights({0.5, 0.5});
                EXPECT_NEAR(glm::length(end), kSize, 1e-9) << distance;
                EXPECT_NEAR(end[axis], axis == 0 ? kSize : -kSize, 1e-9) << "Y points up";
            }
            EXPECT_EQ(find(handles, ObjectTool::Constraint{2, false}), nullptr) << "it points at the eye";
            EXPECT_NE(find(handles, ObjectTool::Constraint{2, true}), nullptr);
            EXPECT_EQ(find(handles, ObjectTool::Constraint{0, true}), nullptr) << "its plane is seen from the edge";
        }
    }
}

TEST(Gizmo, HandlesAreTakenWhereTheyAreSeen) {
    const ViewProjection view = viewFrom({3, 2, 4});
    for (const auto kind : kKinds) {
        const auto handles = gizmoHandles(kind, {{0.2, 0.1, -0.3}}, view, kSize);
        EXPECT_EQ(handles.size(), kind == ObjectTool::Kind::Turn ? 4u : 7u);
        for (const GizmoHandle& handle : handles) {
            glm::dvec2 place(0);
            if (!handle.area.empty()) {
                for (const glm::dvec2& corner : handle.area) place += 0.25 * corner;
            } else { // of rings the place that is farthest from all others
                double farthest = -1;
                for (const auto& [from, to] : handle.lines) {
                    const glm::dvec2 middle = 0.5 * (from + to);
                    double nearest = 1;
                    for (const GizmoHandle& other : handles)
                        for (const auto& [a, b] : other.lines)
                            if (&other != &handle) nearest = std::min(nearest, lengthOf({middle, 0.5 * (a + b)}));
                    if (nearest > farthest) farthest = nearest, place = middle;
                }
            }
            EXPECT_EQ(handleAt(handles, kAspect, place, 0.01), &handle);
        }
        EXPECT_EQ(handleAt(handles, kAspect, {0.05, 0.05}, 0.01), nullptr) << "there the camera is moved";
    }
}

// Of rings the half that is in front; all of one that faces the eye.
TEST(Gizmo, RingsAreHiddenBehind) {
    const auto handles = gizmoHandles(ObjectTool::Kind::Turn, {}, viewFrom({0, 0, 5}), kSize);
    const auto segments = [&](int axis) { return find(handles, ObjectTool::Constraint{axis, false})->lines.size(); };
    EXPECT_EQ(segments(2), 64u);
    EXPECT_GT(segments(0), 30u);
    EXPECT_LT(segments(0), 40u);
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < a; ++b) {
            const auto letter = [&](int axis) { return *find(handles, ObjectTool::Constraint{axis, false})->letter; };
            EXPECT_GT(lengthOf({letter(a), letter(b)}), 0.2 * kSize) << "letters are apart";
        }
}

TEST(Gizmo, FollowsLocalAxesAndIsNotBehindTheEye) {
    const ViewProjection view = viewFrom({0, 0, 5});
    ToolAxes axes;
    axes.directions = scene::toAffine({scene::Rotate{{0, 0, 1}, 30}}).linear;
    const auto handles = gizmoHandles(ObjectTool::Kind::Move, axes, view, kSize);
    const GizmoHandle* x = find(handles, ObjectTool::Constraint{0, false});
    ASSERT_NE(x, nullptr);
    const glm::dvec2 end = inHeights(x->arm->second) - inHeights({0.5, 0.5});
    EXPECT_NEAR(std::atan2(-end.y, end.x), std::atan(1) * 4 / 6, 1e-9);
    for (const auto kind : kKinds) EXPECT_TRUE(gizmoHandles(kind, {{0, 0, 9}}, view, kSize).empty());
}

} // namespace
} // namespace rt::app
