// Places in a picture and what the pointer does with an object: against the camera rays of the engines, and against
// where the moved point is seen afterwards.
#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "Common/App/Interactive/ObjectList.h"
#include "Common/App/Interactive/ObjectTool.h"
#include "Common/Scene/CameraRecord.h"
#include "Common/Shared/Camera.h"
#include "tests/unit/CompilerScenes.h"

namespace rt::app {
namespace {

using scene::expectNear;

scene::CameraDesc camera() {
    scene::CameraDesc camera;
    camera.lookFrom = {3, 2, 7};
    camera.lookAt = {0.5, 0, -1};
    camera.up = {0.1, 1, 0.2};
    camera.verticalFov = 47;
    return camera;
}

constexpr std::uint32_t kWidth = 640, kHeight = 360;
constexpr double kViewAspect = 640.0 / 360;

TEST(ViewProjection, IsTheCameraOfTheEngines) {
    const ViewProjection view(camera(), kViewAspect);
    const shared::Camera record = scene::makeCamera(camera(), kWidth, kHeight, glm::dvec3(0));
    for (const glm::uvec2 pixel : {glm::uvec2(0, 0), glm::uvec2(639, 0), glm::uvec2(100, 300), glm::uvec2(320, 180)}) {
        const shared::Ray ray = shared::generateCameraRay(shared::kFeatureNone, record, pixel, {kWidth, kHeight},
                                                          shared::vec2(0.5f), shared::vec2(0.5f), 0);
        const glm::dvec2 place((pixel.x + 0.5) / kWidth, (pixel.y + 0.5) / kHeight);
        expectNear(glm::normalize(view.direction(place)), glm::dvec3(ray.direction), 1e-6);
        const auto seen = view.place(camera().lookFrom + 4.0 * glm::dvec3(ray.direction));
        ASSERT_TRUE(seen);
        EXPECT_NEAR(seen->x, place.x, 1e-6);
        EXPECT_NEAR(seen->y, place.y, 1e-6);
    }
    EXPECT_FALSE(view.place(2.0 * camera().lookFrom - camera().lookAt)) << "it lies behind";
}

TEST(ViewProjection, LinesAreCutWhereTheyComeFromBehind) {
    const ViewProjection view(camera(), kViewAspect);
    const glm::dvec3 ahead = camera().lookAt, behind = 2.0 * camera().lookFrom - camera().lookAt + glm::dvec3(1, 0, 0);
    const auto whole = view.line(ahead, ahead + glm::dvec3(0.1, 0, 0));
    ASSERT_TRUE(whole);
    EXPECT_NEAR(whole->first.x, 0.5, 1e-12);
    EXPECT_NEAR(whole->first.y, 0.5, 1e-12);
    for (const auto& part : {view.line(ahead, behind), view.line(behind, ahead)}) {
        ASSERT_TRUE(part);
        EXPECT_TRUE(std::isfinite(part->first.x + part->second.y));
    }
    EXPECT_FALSE(view.line(behind, behind + glm::dvec3(1, 0, 0)));
}

glm::dvec2 seenAt(const ViewProjection& view, const glm::dvec3& point) {
    const auto place = view.place(point);
    EXPECT_TRUE(place);
    return place.value_or(glm::dvec2(0));
}

glm::dvec3 pointAfter(const ObjectTool& tool, const ViewProjection& view, const glm::dvec2& place,
                      const glm::dvec3& point, bool isSnapped = false) {
    const auto motion = tool.motion(view, place, isSnapped);
    EXPECT_TRUE(motion);
    return motion ? scene::toAffine(motion->steps).point(point) : glm::dvec3(NAN);
}

glm::dvec3 vectorAfter(const ObjectTool& tool, const ViewProjection& view, const glm::dvec2& place,
                       const glm::dvec3& vector) {
    const auto motion = tool.motion(view, place, false);
    EXPECT_TRUE(motion);
    return motion ? scene::toAffine(motion->steps).vector(vector) : glm::dvec3(NAN);
}

// About the axis (1, 1, 0) by some angle: no axis is one of the scene's.
glm::dmat3 turnedAxes() {
    return scene::toAffine({scene::Rotate{{1, 1, 0}, 35}}).linear;
}

// What the pointer had stays under it; along an axis as near as that allows.
TEST(ObjectTool, MovesWithThePointer) {
    const ViewProjection view(camera(), kViewAspect);
    const glm::dvec3 pivot(0.3, 0.2, -0.5);
    const glm::dvec2 start = seenAt(view, pivot), end = start + glm::dvec2(0.13, -0.07);
    for (const glm::dmat3& axes : {glm::dmat3(1.0), turnedAxes()}) {
        ObjectTool tool(ObjectTool::Kind::Move, {pivot, axes}, start);
        EXPECT_FALSE(tool.motion(view, start, false));
        const glm::dvec3 moved = pointAfter(tool, view, end, pivot);
        EXPECT_LT(glm::length(seenAt(view, moved) - end), 1e-12);
        EXPECT_NEAR(glm::dot(moved - pivot, view.forward()), 0, 1e-12);
        for (int axis = 0; axis < 3; ++axis) {
            const glm::dvec3 wanted = pivot + 0.7 * axes[axis];
            tool.constrain(axis);
            expectNear(pointAfter(tool, view, seenAt(view, wanted), pivot), wanted, 1e-9);
            const glm::dvec3 inPlane = pivot + 0.4 * axes[(axis + 1) % 3] - 0.3 * axes[(axis + 2) % 3];
            const ObjectTool square(ObjectTool::Kind::Move, {pivot, axes}, start, ObjectTool::Constraint{axis, true},
                                    1);
            expectNear(pointAfter(square, view, seenAt(view, inPlane), pivot), inPlane, 1e-9);
        }
        tool.constrain(2); // once more
        EXPECT_FALSE(tool.constraint());
    }
}

// A point beside the pivot is seen to go round as the pointer does.
TEST(ObjectTool, TurnsWithThePointer) {
    scene::CameraDesc straight;
    straight.lookFrom = {0, 0, 5};
    straight.lookAt = {0, 0, 0};
    for (const bool fromBehind : {false, true}) {
        if (fromBehind) straight.lookFrom = {0, 0, -5};
        const ViewProjection view(straight, 1);
        const glm::dvec3 beside(1, 0, 0), after(std::cos(0.5), std::sin(0.5), 0);
        ObjectTool tool(ObjectTool::Kind::Turn, {}, seenAt(view, beside));
        for (const bool isAboutZ : {false, true}) {
            if (isAboutZ) tool.constrain(2);
            expectNear(pointAfter(tool, view, seenAt(view, after), beside), after, 1e-9);
        }
    }
}

// What the pointer has of a ring stays under it, however that is seen; of one seen from its edge roughly.
TEST(ObjectTool, RingsFollowThePointer) {
    const ViewProjection view(camera(), kViewAspect);
    const glm::dvec3 pivot(0.3, 0.2, -0.5), toEye = glm::normalize(view.eye() - pivot);
    int rings = 0;
    for (const glm::dmat3& axes : {glm::dmat3(1.0), turnedAxes()})
        for (int axis = 0; axis < 3; ++axis) {
            const glm::dvec3 &u = axes[(axis + 1) % 3], &v = axes[(axis + 2) % 3];
            const auto at = [&](double angle) { return pivot + std::cos(angle) * u + std::sin(angle) * v; };
            const ObjectTool tool(ObjectTool::Kind::Turn, {pivot, axes}, seenAt(view, at(0.2)),
                                  ObjectTool::Constraint{axis, false}, 1);
            if (std::abs(glm::dot(axes[axis], toEye)) < 0.3) continue;
            expectNear(pointAfter(tool, view, seenAt(view, at(1.1)), at(0.2)), at(1.1), 1e-9);
            ++rings;
        }
    EXPECT_GE(rings, 3);
    scene::CameraDesc straight;
    straight.lookFrom = {0, 0, 50};
    straight.lookAt = {0, 0, 0};
    straight.verticalFov = 5;
    const ViewProjection front(straight, 1);
    const ObjectTool edge(ObjectTool::Kind::Turn, {}, seenAt(front, {0, 0, 1}), ObjectTool::Constraint{0, false}, 1);
    const double small = 0.05; // about X from +Z towards -Y
    expectNear(pointAfter(edge, front, seenAt(front, {0, -small, 1}), {0, 0, 1}), {0, -small, 1}, 3e-3);
}

TEST(ObjectTool, ScalesByTheDistanceFromTheMiddle) {
    const ViewProjection view(camera(), kViewAspect);
    const glm::dvec3 pivot(0.3, 0.2, -0.5);
    const glm::dvec2 middle = seenAt(view, pivot), start = middle + glm::dvec2(0.1, 0.05);
    const glm::dvec2 away = middle + 2.5 * (start - middle);
    ObjectTool tool(ObjectTool::Kind::Scale, {pivot}, start);
    expectNear(pointAfter(tool, view, away, pivot), pivot, 1e-12);
    expectNear(vectorAfter(tool, view, away, {1, 2, 3}), {2.5, 5, 7.5}, 1e-9);
    tool.constrain(1);
    expectNear(vectorAfter(tool, view, away, {1, 2, 3}), {1, 5, 3}, 1e-9);
    EXPECT_TRUE(scene::inverse(scene::toAffine(tool.motion(view, middle, false)->steps))) << "never to nothing";
    EXPECT_EQ(tool.motion(view, away, false)->text, "Scale along Y: 1, 2.5, 1");
}

// An arm's end stays under the pointer, and an object of other axes is scaled along those.
TEST(ObjectTool, ArmsScaleAlongTheirAxes) {
    const ViewProjection view(camera(), kViewAspect);
    const glm::dvec3 pivot(0.3, 0.2, -0.5);
    const glm::dmat3 axes = turnedAxes();
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 end = pivot + 0.5 * axes[axis], wanted = pivot + 0.8 * axes[axis];
        const ObjectTool arm(ObjectTool::Kind::Scale, {pivot, axes}, seenAt(view, end),
                             ObjectTool::Constraint{axis, false}, 0.5);
        const glm::dvec2 place = seenAt(view, wanted);
        expectNear(pointAfter(arm, view, place, end), wanted, 1e-9);
        const glm::dvec3 across = axes[(axis + 1) % 3];
        expectNear(vectorAfter(arm, view, place, across), across, 1e-9);
        const ObjectTool square(ObjectTool::Kind::Scale, {pivot, axes}, seenAt(view, end),
                                ObjectTool::Constraint{axis, true}, 0.5);
        expectNear(vectorAfter(square, view, place, axes[axis]), axes[axis], 1e-9);
        EXPECT_GT(glm::length(vectorAfter(square, view, place, across)), 1.2);
    }
}

TEST(ObjectTool, SnapsToWholeSteps) {
    const ViewProjection view(camera(), kViewAspect);
    const glm::dvec3 pivot(0.3, 0.2, -0.5);
    const glm::dvec2 start = seenAt(view, pivot);
    ObjectTool move(ObjectTool::Kind::Move, {pivot}, start);
    const double step = move.moveStep(view);
    EXPECT_EQ(step, 0.2) << "the picture is 6.7 high there";
    move.constrain(0);
    const glm::dvec3 right(1, 0, 0);
    for (const double way : {0.28, 0.62, -0.09, -0.31}) {
        const glm::dvec3 moved = pointAfter(move, view, seenAt(view, pivot + way * right), pivot, true);
        EXPECT_NEAR(moved.x - pivot.x, std::round(way / step) * step, 1e-12);
    }
    const auto motion = move.motion(view, seenAt(view, pivot + 0.62 * right), true);
    EXPECT_EQ(motion->text, "Move along X: 0.6 by steps of 0.2");
    EXPECT_EQ(std::get<scene::Translate>(motion->steps[0]).offset, glm::dvec3(0.6, 0, 0)) << "as it is written";
    scene::CameraDesc straight;
    straight.lookFrom = {0, 0, 5};
    straight.lookAt = {0, 0, 0};
    const ViewProjection front(straight, 1);
    const auto at = [&](double degrees, double radius) {
        const double angle = glm::radians(degrees);
        return seenAt(front, {radius * std::cos(angle), radius * std::sin(angle), 0});
    };
    ObjectTool turn(ObjectTool::Kind::Turn, {}, at(0, 1)), scale(ObjectTool::Kind::Scale, {}, at(0, 1));
    EXPECT_EQ(turn.motion(front, at(40, 1), true)->text, "Turn: 45.0 degrees");
    EXPECT_EQ(turn.motion(front, at(-5, 1), true)->text, "Turn: 0.0 degrees");
    EXPECT_EQ(scale.motion(front, at(0, 1.33), true)->text, "Scale: 1.3, 1.3, 1.3");
    EXPECT_EQ(scale.motion(front, at(0, 0.01), true)->text, "Scale: 0.1, 0.1, 0.1") << "not to nothing";
}

TEST(ObjectTool, StepsAreRoundNumbersAtAnyDistance) {
    for (const double distance : {1e-4, 0.03, 1.0, 7.0, 450.0, 1e6}) {
        scene::CameraDesc camera;
        camera.lookFrom = {0, 0, distance};
        camera.lookAt = {0, 0, 0};
        const ViewProjection view(camera, 1);
        const double step = ObjectTool(ObjectTool::Kind::Move, {}, {0, 0}).moveStep(view);
        const double share = step / view.heightAt(glm::dvec3(0));
        const double mantissa = step / std::pow(10, std::floor(std::log10(step * 1.000001)));
        EXPECT_GT(share, 1.0 / 63) << distance;
        EXPECT_LE(share, 1.0 / 25) << distance;
        EXPECT_TRUE(std::abs(mantissa - 1) < 1e-9 || std::abs(mantissa - 2) < 1e-9 || std::abs(mantissa - 5) < 1e-9)
            << step;
    }
}

// ---- the tree ------------------------------------------------------------------------------------------------------

TEST(ObjectList, HasARowForWhatIsNotWithinClosedGroups) {
    scene::SceneDesc scene = scene::withMaterials();
    scene::GroupDesc inner, outer;
    scene::SphereDesc glassBall;
    glassBall.material = "glass";
    inner.objects = {{glassBall}, {scene::BoxDesc{}}};
    outer.objects = {{scene::DiskDesc{}}, {inner}, {scene::QuadDesc{}}};
    scene.objects = {{scene::SphereDesc{}}, {outer}, {scene::PointLightDesc{}}};
    ObjectList list;
    const auto expectRows = [&](const std::vector<std::string>& paths) {
        ASSERT_EQ(list.size(), paths.size());
        for (std::size_t row = 0; row < paths.size(); ++row) {
            EXPECT_EQ(textOf(list.path(row)), paths[row]);
            EXPECT_EQ(list.find(list.path(row)), row);
        }
    };
    list.build(scene, {}, "");
    expectRows({"/objects/0", "/objects/1", "/objects/2"});
    EXPECT_EQ(list.find({"", {1, 0}}), list.size());
    std::set<scene::ObjectPath> open = {{"", {1}}};
    list.build(scene, open, "");
    expectRows({"/objects/0", "/objects/1", "/objects/1/objects/0", "/objects/1/objects/1", "/objects/1/objects/2",
                "/objects/2"});
    EXPECT_EQ(list.depth(3), 1u);
    open.insert({"", {1, 1}});
    list.build(scene, open, "");
    EXPECT_EQ(list.size(), 8u);
    EXPECT_EQ(textOf(list.path(5)), "/objects/1/objects/1/objects/1");
    list.build(scene, {}, "GLASS");
    expectRows({"/objects/1/objects/1/objects/0"});
    list.build(scene, {}, "sphere");
    expectRows({"/objects/0", "/objects/1/objects/1/objects/0"});
    list.build(scene, {}, "nothing");
    EXPECT_EQ(list.size(), 0u);
    EXPECT_EQ(labelOf({glassBall}), "Sphere  glass");
    EXPECT_EQ(labelOf({outer}), "Group  of 3");
}

} // namespace
} // namespace rt::app
