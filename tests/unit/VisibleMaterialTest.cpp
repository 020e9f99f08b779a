// Which material a pixel shows: scenes of which one knows it.
#include <gtest/gtest.h>

#include "Common/App/Interactive/VisibleMaterial.h"
#include "tests/unit/CompilerScenes.h"

namespace rt::app {
namespace {

using namespace scene;

// From the origin along -z, 90 degrees high: pixel (x, y) of 4 x 4 is seen at ((2 x - 3) / 4, (3 - 2 y) / 4, -1).
std::string seen(const SceneDesc& desc, std::uint32_t x, std::uint32_t y) {
    const auto compiled = compileScene(desc);
    EXPECT_EQ(compiled->materialNames.size(), compiled->materials.size());
    const auto material = visibleMaterial(*compiled, desc.camera, {4, 4}, {x, y});
    return material ? compiled->materialNames[*material] : "nothing";
}

TEST(VisibleMaterial, TheNearestOfAllKinds) {
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

TEST(VisibleMaterial, InstancesAndWhatReplacesTheirMaterials) {
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

TEST(VisibleMaterial, TooMuchIsNotLookedThrough) {
    SceneDesc scene = withMaterials();
    SphereSetDesc cloud;
    cloud.material = "matte";
    cloud.radius = 0.01;
    for (int i = 0; i < 2000; ++i) cloud.centers.push_back({0, 0, -4 - 0.001 * i});
    scene.prototypes["cloud"] = {{cloud}};
    for (int i = 0; i < 3000; ++i) scene.objects.push_back({InstanceDesc{"cloud", {Translate{{-3, 3, 0}}}, ""}});
    EXPECT_EQ(seen(scene, 3, 3), "nothing") << "boxes alone are tested there";
    const auto compiled = compileScene(scene);
    EXPECT_FALSE(visibleMaterial(*compiled, scene.camera, {4, 4}, {0, 0}));
    scene.objects.resize(100);
    EXPECT_EQ(seen(scene, 0, 0), "matte");
}

} // namespace
} // namespace rt::app
