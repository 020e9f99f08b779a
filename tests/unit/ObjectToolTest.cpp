// Places in a picture and what the pointer does with an object: against the camera rays of the engines, and against
// where the moved point is seen afterwards.
#include <algorithm>
#include <cmath>
#include <random>
#include <set>

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
constexpr double kAspect = 640.0 / 360;

TEST(ViewProjection, IsTheCameraOfTheEngines) {
    const ViewProjection view(camera(), kAspect);
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
    const ViewProjection view(camera(), kAspect);
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

// What the pointer had stays under it; along an axis as near as that allows.
TEST(ObjectTool, MovesWithThePointer) {
    const ViewProjection view(camera(), kAspect);
    const glm::dvec3 pivot(0.3, 0.2, -0.5);
    const glm::dvec2 start = seenAt(view, pivot), end = start + glm::dvec2(0.13, -0.07);
    ObjectTool tool(ObjectTool::Kind::Move, pivot, start);
    EXPECT_FALSE(tool.steps(view, start));
    const auto free = tool.steps(view, end);
    ASSERT_TRUE(free);
    const glm::dvec3 moved = scene::toAffine(*free).point(pivot);
    EXPECT_LT(glm::length(seenAt(view, moved) - end), 1e-12);
    EXPECT_NEAR(glm::dot(moved - pivot, view.forward()), 0, 1e-12);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 wanted = pivot;
        wanted[axis] += 0.7;
        tool.constrain(axis);
        const auto steps = tool.steps(view, seenAt(view, wanted));
        ASSERT_TRUE(steps);
        expectNear(scene::toAffine(*steps).point(pivot), wanted, 1e-9);
    }
    tool.constrain(2); // once more
    EXPECT_FALSE(tool.axis());
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
        ObjectTool tool(ObjectTool::Kind::Turn, {0, 0, 0}, seenAt(view, beside));
        for (const bool isAboutZ : {false, true}) {
            if (isAboutZ) tool.constrain(2);
            const auto steps = tool.steps(view, seenAt(view, after));
            ASSERT_TRUE(steps);
            expectNear(scene::toAffine(*steps).point(beside), after, 1e-9);
        }
    }
}

TEST(ObjectTool, ScalesByTheDistanceFromTheMiddle) {
    const ViewProjection view(camera(), kAspect);
    const glm::dvec3 pivot(0.3, 0.2, -0.5);
    const glm::dvec2 middle = seenAt(view, pivot), start = middle + glm::dvec2(0.1, 0.05);
    ObjectTool tool(ObjectTool::Kind::Scale, pivot, start);
    const auto steps = tool.steps(view, middle + 2.5 * (start - middle));
    ASSERT_TRUE(steps);
    expectNear(scene::toAffine(*steps).point(pivot), pivot, 1e-12);
    expectNear(scene::toAffine(*steps).vector({1, 2, 3}), {2.5, 5, 7.5}, 1e-9);
    tool.constrain(1);
    expectNear(scene::toAffine(*tool.steps(view, middle + 2.5 * (start - middle))).vector({1, 2, 3}), {1, 5, 3}, 1e-9);
    EXPECT_TRUE(scene::inverse(scene::toAffine(*tool.steps(view, middle)))) << "nothing is scaled to nothing";
    EXPECT_EQ(tool.text(scene::Transform{scene::Translate{}, scene::Scale{{1, 2, 1}}, scene::Translate{}}),
              "Scale along Y: 1, 2, 1");
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
