// Which surface a pixel shows, and of which object it is: scenes of which one knows it.
#include <gtest/gtest.h>

#include "Common/App/Interactive/VisibleSurface.h"
#include "tests/unit/CompilerScenes.h"

namespace rt::app {
namespace {

using namespace scene;

// From the origin along -z, 90 degrees high: pixel (x, y) of 4 x 4 is seen at ((2 x - 3) / 4, (3 - 2 y) / 4, -1).
std::string seen(const SceneDesc& desc, std::uint32_t x, std::uint32_t y) {
    const auto compiled = compileScene(desc);
    EXPECT_EQ(compiled->materialNames.size(), compiled->materials.size());
    const auto surface = visibleSurface(*compiled, desc.camera, {4, 4}, {x, y});
    return surface ? compiled->materialNames[surface->material] : "nothing";
}

TEST(VisibleSurface, TheNearestOfAllKinds) {
    SceneDesc scene = withMaterials();
    scene.materials["far"] = lambertian(1, 1, 1);
    scene.materials["mesh"] = lambertian(1, 0, 0);
    add(scene, quad({-9, -9, -5}, {18, 0, 0}, {0, 9, 0}, "far")); // the lower half
    add(scene, sphere({-3, 3, -4}, 0.5, "glass"));                // pixel (0, 0)
    MeshDesc mesh;
    mesh.source = MeshData{{{1, -1, -2}, {3, -1, -2}, {1, -3, -2}}, {}, {}, {}, {}, {}, {{0, 1, 2}}};
    mesh.material = "mesh";
    scene.objects.push_back({mesh}); // pixel (3, 3), before the quad
    EXPECT_EQ(seen(scene, 0, 0), "glass");
    EXPECT_EQ(seen(scene, 1, 0), "nothing");
    EXPECT_EQ(seen(scene, 0, 3), "far");
    EXPECT_EQ(seen(scene, 3, 3), "mesh");
    SphereDesc moving = sphere({-3, 3, -4}, 0.1, "glass");
    moving.center = {-9, 3, -4};
    moving.centerEnd = glm::dvec3(3, 3, -4);
    scene.objects = {{moving}};
    EXPECT_EQ(seen(scene, 0, 0), "glass") << "where it is halfway";
}

TEST(VisibleSurface, InstancesAndWhatReplacesTheirMaterials) {
    SceneDesc scene = withMaterials();
    scene.prototypes["pair"] = {{sphere({0, 0, 0}, 0.5, "matte")}, {quad({-4, -4, -1}, {8, 0, 0}, {0, 8, 0}, "glass")}};
    for (const double x : {-3.0, 3.0}) {
        InstanceDesc instance{"pair", {Scale{{1, 1, 1}}, Translate{{x, 3, -4}}}, x > 0 ? "lamp" : ""};
        scene.objects.push_back({instance});
    }
    EXPECT_EQ(seen(scene, 0, 0), "matte");
    EXPECT_EQ(seen(scene, 3, 0), "lamp");
    EXPECT_EQ(seen(scene, 1, 0), "glass");
    scene.camera.lookFrom = {0, 0, -100}; // with all of it behind the camera
    scene.camera.lookAt = {0, 0, -101};
    EXPECT_EQ(seen(scene, 0, 0), "nothing");
}

// The object that a pixel shows, and bounds of it that hold what is known of it.
TEST(VisibleSurface, IsThatOfAnObject) {
    SceneDesc scene = withMaterials();
    SphereSetDesc cloud; // enough for a geometry that instances share
    cloud.material = "matte";
    cloud.radius = 0.25;
    cloud.centers.assign(100, glm::dvec3(0));
    scene.prototypes["cloud"] = {{cloud}};
    scene.prototypes["one"] = {{sphere({0, 0, 0}, 0.25, "glass")}};
    const auto at = [](double x, double y) { return glm::dvec3(x, y, -4); }; // of pixels: -3, -1, 1, 3
    GroupDesc row = group({Translate{at(0, 1)}}, sphere({-3, 0, 0}, 0.5, "matte"));
    row.objects.push_back({quad({-1.5, -0.5, 0}, {1, 0, 0}, {0, 1, 0}, "glass")});
    row.objects.push_back({InstanceDesc{"one", {Translate{{1, 0, 0}}}, ""}});
    scene.objects = {{InstanceDesc{"cloud", {Translate{at(-3, 3)}}, ""}},
                     {InstanceDesc{"cloud", {Translate{at(-1, 3)}}, ""}},
                     {PointLightDesc{}},
                     {row},
                     {group({Scale{{1, 2, 1}}, Translate{at(3, -1)}}, sphere({0, 0, 0}, 0.5, "matte"))}};
    const auto compiled = compileScene(scene);
    ASSERT_GT(compiled->instances.size(), 2u);
    const auto objectAt = [&](std::uint32_t x, std::uint32_t y) {
        const auto surface = visibleSurface(*compiled, scene.camera, {4, 4}, {x, y});
        return surface ? surface->object : 99u;
    };
    EXPECT_EQ(objectAt(0, 0), 0u);
    EXPECT_EQ(objectAt(1, 0), 1u);
    EXPECT_EQ(objectAt(0, 1), 3u);
    EXPECT_EQ(objectAt(1, 1), 4u);
    EXPECT_EQ(objectAt(2, 1), 5u);
    EXPECT_EQ(objectAt(3, 2), 6u);
    EXPECT_EQ(objectAt(2, 3), 99u);
    const auto expectBounds = [&](std::uint32_t first, std::uint32_t count, const glm::dvec3& low,
                                  const glm::dvec3& high) {
        const Bounds bounds = boundsOf(*compiled, std::vector<ObjectRange>{{first, count}}).front();
        expectNear(bounds.lower, low, 1e-5);
        expectNear(bounds.upper, high, 1e-5);
    };
    expectBounds(0, 1, at(-3, 3) - 0.25, at(-3, 3) + 0.25);
    expectBounds(3, 1, at(-3, 1) - 0.5, at(-3, 1) + 0.5);
    expectBounds(4, 1, at(-1.5, 0.5), at(-0.5, 1.5));
    expectBounds(6, 1, at(3, -1) - glm::dvec3(0.5, 1, 0.5), at(3, -1) + glm::dvec3(0.5, 1, 0.5));
    expectBounds(3, 3, {-3.5, 0.5, -4.5}, {1.25, 1.5, -3.5});
    const std::vector<ObjectRange> ranges = {{0, 1}, {2, 1}, {3, 0}, {3, 1}, {5, 2}};
    const std::vector<Bounds> bounds = boundsOf(*compiled, ranges); // each as if it were asked for alone
    ASSERT_EQ(bounds.size(), ranges.size());
    EXPECT_TRUE(bounds[1].empty()) << "a light without extent";
    EXPECT_TRUE(bounds[2].empty()) << "none";
    for (const std::size_t i : {0u, 3u, 4u}) {
        const Bounds alone = boundsOf(*compiled, std::vector<ObjectRange>{ranges[i]}).front();
        EXPECT_FALSE(alone.empty());
        EXPECT_EQ(bounds[i].lower, alone.lower);
        EXPECT_EQ(bounds[i].upper, alone.upper);
    }
}

TEST(VisibleSurface, TooMuchIsNotLookedThrough) {
    SceneDesc scene = withMaterials();
    SphereSetDesc cloud;
    cloud.material = "matte";
    cloud.radius = 0.01;
    for (int i = 0; i < 2000; ++i) cloud.centers.emplace_back(0, 0, -4 - 0.001 * i);
    scene.prototypes["cloud"] = {{cloud}};
    for (int i = 0; i < 3000; ++i) scene.objects.push_back({InstanceDesc{"cloud", {Translate{{-3, 3, 0}}}, ""}});
    EXPECT_EQ(seen(scene, 3, 3), "nothing") << "boxes alone are tested there";
    const auto compiled = compileScene(scene);
    EXPECT_FALSE(visibleSurface(*compiled, scene.camera, {4, 4}, {0, 0}));
    scene.objects.resize(100);
    EXPECT_EQ(seen(scene, 0, 0), "matte");
}

} // namespace
} // namespace rt::app
