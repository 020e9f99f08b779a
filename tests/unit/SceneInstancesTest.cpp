// Prototypes and instances in the scene compiler: what becomes an instance, where it stands.
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "Common/Scene/Affine.h"
#include "tests/unit/CompilerScenes.h"

namespace rt::scene {
namespace {

void addInstance(SceneDesc& scene, const std::string& prototype, Transform transform,
                 const std::string& material = "") {
    InstanceDesc instance;
    instance.prototype = prototype;
    instance.transform = std::move(transform);
    instance.material = material;
    add(scene, instance);
}

glm::dvec3 placed(const shared::Instance& instance, const glm::dvec3& p) {
    glm::dvec3 q;
    for (int row = 0; row < 3; ++row) q[row] = glm::dot(glm::dvec3(instance.toWorld[row]), p) + instance.toWorld[row].w;
    return q;
}

glm::dvec3 placedBack(const shared::Instance& instance, const glm::dvec3& p) {
    glm::dvec3 q;
    for (int row = 0; row < 3; ++row)
        q[row] = glm::dot(glm::dvec3(instance.toObject[row]), p) + instance.toObject[row].w;
    return q;
}

TEST(SceneInstances, LargePrototypesBecomeInstancesSmallOnesCopies) {
    SceneDesc scene = withMaterials();
    scene.prototypes["large"] = {{mesh(icosphere(1), "matte")}};
    scene.prototypes["small"] = {{mesh(icosphere(0), "matte")}};
    scene.prototypes["single"] = {{mesh(icosphere(1), "matte")}};
    const Transform turn = {Scale{{1, 2, 3}}, Rotate{{1, 0, 0}, 30}, Translate{{5, 6, 7}}};
    for (const char* name : {"large", "small"}) {
        addInstance(scene, name, turn);
        addInstance(scene, name, {}, "glass");
    }
    addInstance(scene, "single", turn);
    const auto compiled = compileScene(scene);
    ASSERT_EQ(compiled->geometries.size(), 2u);
    EXPECT_EQ(compiled->geometries[0].triangleCount, 20u + 20u + 80u);
    EXPECT_EQ(compiled->geometries[1].triangleCount, 80u);
    ASSERT_EQ(compiled->instances.size(), 2u);
    EXPECT_EQ(compiled->instances[0].material, shared::kNone);
    EXPECT_EQ(compiled->materials[compiled->instances[1].material].kind, shared::kMaterialDielectric);
    const Affine map = toAffine(turn);
    for (const glm::dvec3& p : icosphere(1).positions) {
        expectNear(placed(compiled->instances[0], p), map.point(p), 1e-5);
        expectNear(placedBack(compiled->instances[0], map.point(p)), p, 1e-5);
    }
}

TEST(SceneInstances, NestedInstancesFlattenToOneLevel) {
    SceneDesc scene = withMaterials();
    scene.prototypes["ball"] = {{mesh(icosphere(1), "matte")}};
    InstanceDesc inner;
    inner.prototype = "ball";
    for (int i = 0; i < 3; ++i) {
        inner.transform = {Translate{{double(i), 0, 0}}};
        scene.prototypes["row"].push_back({inner});
    }
    addInstance(scene, "row", {Translate{{0, 10, 0}}});
    add(scene, group({Scale{glm::dvec3(2)}}, scene.objects[0].shape));
    const auto compiled = compileScene(scene);
    ASSERT_EQ(compiled->instances.size(), 6u);
    for (int i = 0; i < 3; ++i) {
        expectNear(placed(compiled->instances[static_cast<std::size_t>(i)], {0, 0, 0}), {i, 10, 0}, 0);
        expectNear(placed(compiled->instances[static_cast<std::size_t>(i + 3)], {0, 0, 0}), {2 * i, 20, 0}, 0);
    }
}

TEST(SceneInstances, EmittersOfInstancesAreWorldPrimitives) {
    SceneDesc scene = withMaterials();
    SphereDesc moving = sphere({0, 4, 0}, 0.5, "matte");
    moving.centerEnd = glm::dvec3(0, 5, 0);
    scene.prototypes["lamp post"] = {{mesh(icosphere(1), "matte")}, {sphere({0, 2, 0}, 0.5, "lamp")}, {moving}};
    addInstance(scene, "lamp post", {Translate{{10, 0, 0}}});
    addInstance(scene, "lamp post", {Scale{glm::dvec3(2)}});
    addInstance(scene, "lamp post", {}, "lamp");
    const auto compiled = compileScene(scene);
    EXPECT_EQ(compiled->instances.size(), 2u);
    EXPECT_EQ(compiled->geometries[0].sphereCount, 6u);
    EXPECT_EQ(compiled->geometries[0].triangleCount, 80u);
    EXPECT_EQ(compiled->geometries[1].sphereCount, 0u);
    ASSERT_EQ(compiled->globals.lightCount, 1u + 1u + 82u);
    expectNear(compiled->lights[0].position, {10, 2, 0}, 0);
    expectNear(compiled->lights[1].position, {0, 4, 0}, 0);
    EXPECT_EQ(compiled->lights[1].radius, 1.0f);
    // A moving light carries its displacement.
    EXPECT_EQ(compiled->lights.back().kind, shared::kLightSphere);
    expectNear(compiled->lights.back().edgeU, {0, 1, 0}, 0);
}

TEST(SceneInstances, StretchedSpheresAreInstancesOfTheUnitSphere) {
    SceneDesc scene = withMaterials();
    add(scene, group({Scale{{1, 2, 3}}, Rotate{{0, 1, 0}, 20}}, sphere({1, 1, 1}, 0.5, "matte")));
    add(scene, group({Scale{{2, 1, 1}}}, sphere({0, 0, 0}, 1, "glass")));
    add(scene, group({Scale{{-2, 2, 2}}, Rotate{{1, 1, 0}, 70}}, sphere({0, 0, 0}, 1, "glass"))); // still a sphere
    const auto compiled = compileScene(scene);
    ASSERT_EQ(compiled->instances.size(), 2u);
    ASSERT_EQ(compiled->geometries.size(), 2u);
    EXPECT_EQ(compiled->geometries[0].sphereCount, 1u);
    EXPECT_EQ(compiled->geometries[1].sphereCount, 1u);
    expectNear(placed(compiled->instances[0], {0, 1, 0}), rotatedY({1, 3, 3}, 20), 1e-6);
    EXPECT_EQ(compiled->materials[compiled->instances[1].material].kind, shared::kMaterialDielectric);

    SphereDesc moving = sphere({0, 0, 0}, 1, "matte");
    moving.centerEnd = glm::dvec3(1, 0, 0);
    SceneDesc bad = withMaterials();
    add(bad, group({Scale{{1, 2, 1}}}, moving));
    EXPECT_NE(errorOf(bad).find("test: /objects/0/objects/0: a moving sphere"), std::string::npos);
}

TEST(SceneInstances, StretchedLampsAreLightsUnlessTheyAreTakenOffTheList) {
    SceneDesc scene = withMaterials();
    add(scene, group({Scale{{1, 2, 1}}}, sphere({0, 1, 0}, 1, "lamp")));
    SphereDesc unlisted = sphere({0, 1, 0}, 1, "lamp");
    unlisted.light = false;
    add(scene, group({Scale{{1, 2, 1}}}, unlisted));
    add(scene, sphere({5, 0, 0}, 1, "lamp"));
    add(scene, group({Scale{{1, 1e-12, 1}}}, sphere({0, 1, 0}, 1, "lamp"))); // too thin
    const auto compiled = compileScene(scene);
    ASSERT_EQ(compiled->instances.size(), 2u);
    EXPECT_EQ(compiled->instances[0].light, 0u);
    EXPECT_EQ(compiled->instances[1].light, shared::kNone);
    ASSERT_EQ(compiled->lights.size(), 2u);
    EXPECT_EQ(compiled->lights[0].kind, shared::kLightEllipsoid);
    EXPECT_EQ(compiled->lights[1].kind, shared::kLightSphere);
    expectNear(compiled->lights[0].position, {0, 2, 0}, 0);
    expectNear(compiled->lights[0].edgeV, {0, 2, 0}, 1e-6);
    EXPECT_TRUE(shared::has(compiled->features, shared::kFeatureEllipsoidLights));
    ASSERT_EQ(compiled->notices.size(), 1u);
    EXPECT_NE(compiled->notices[0].find("1 sphere without"), std::string::npos);
}

TEST(SceneInstances, TurnedMapsTurn) {
    SceneDesc scene = withMaterials();
    scene.textures["map"] = ImageTexture{"none.jpg", "mars", glm::dvec3(1)};
    scene.materials["mapped"] = lambertian(std::string("map"));
    add(scene, group({Rotate{{0, 1, 0}, 90}}, sphere({0, 0, 0}, 1, "mapped")));
    add(scene, group({Scale{glm::dvec3(2)}}, sphere({0, 0, 0}, 1, "mapped")));
    const auto compiled = compileScene(scene);
    EXPECT_EQ(compiled->instances.size(), 1u);
    EXPECT_EQ(compiled->geometries[0].sphereCount, 1u);
    EXPECT_EQ(compiled->images.size(), 1u);
}

} // namespace
} // namespace rt::scene
