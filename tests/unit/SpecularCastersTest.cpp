// Which smooth spheres the scene compiler finds for connections to lights.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Scene/Compiler/SpecularCasters.h"
#include "tests/ConnectedScene.h"
#include "tests/unit/CompilerScenes.h"
#include "tests/unit/Statistics.h"

namespace rt::scene {
namespace {

// So many that a prototype with them becomes a real instance.
SphereSetDesc beads(const std::string& material) {
    SphereSetDesc set;
    set.radius = 0.01;
    set.material = material;
    for (int i = 0; i < 64; ++i) set.centers.emplace_back(0.1 * i, -1, 0);
    return set;
}

SceneDesc litFloor() {
    SceneDesc scene = withMaterials();
    scene.camera.lookFrom = {1, 2, 8};
    scene.materials["dense"] = glass(1.8);
    scene.materials["dense"].albedo = glm::dvec3(0.9, 0.8, 1);
    add(scene, QuadDesc{{-0.1, 6, -0.1}, {0.2, 0, 0}, {0, 0, 0.2}, "lamp"});
    return scene;
}

InstanceDesc instanceOf(const std::string& prototype, Transform transform, const std::string& material = "") {
    InstanceDesc instance;
    instance.prototype = prototype;
    instance.transform = std::move(transform);
    instance.material = material;
    return instance;
}

const Transform kTurned = {Scale{glm::dvec3(1.7)}, Rotate{{1, 2, 3}, 50}, Translate{{-2, 1, 0}}};
const Transform kMirrored = {Scale{{-0.6, 0.6, 0.6}}, Rotate{{0, 1, 0}, 20}, Translate{{2, 0, 1}}};
const Transform kFlattened = {Scale{{1, 0.8, 1}}, Translate{{0, 1, 2}}};

// Smooth spheres of prototypes are listed as copies of these spheres in their place would be.
TEST(SpecularCasters, OfInstancesAreThoseOfCopies) {
    const std::vector<ObjectDesc> ball = {{sphere({0.3, 0.5, -0.2}, 0.5, "glass")}, {beads("matte")}};
    SceneDesc instances = litFloor(), copies = litFloor();
    instances.prototypes["ball"] = ball;
    for (const Transform& transform : {kTurned, kMirrored, kFlattened}) {
        add(instances, instanceOf("ball", transform));
        GroupDesc group;
        group.transform = transform;
        group.objects = ball;
        add(copies, std::move(group));
    }
    const auto instanced = test::connectedThroughAll(*compileScene(instances));
    const auto copied = test::connectedThroughAll(*compileScene(copies));
    ASSERT_EQ(instanced->instances.size(), 3u);
    constexpr std::size_t kListed = 6; // two balls, three ways
    ASSERT_EQ(instanced->specularCasters.size(), kListed);
    ASSERT_EQ(copied->specularCasters.size(), kListed);
    ASSERT_EQ(instanced->casterLights.size(), kListed);
    std::array<int, 3> ways{};
    for (std::size_t i = 0; i < kListed; ++i) {
        const shared::SpecularCaster& a = instanced->specularCasters[i];
        const shared::SpecularCaster& b = copied->specularCasters[i];
        ASSERT_LE(a.crossings, shared::kReflectedInside);
        ++ways[a.crossings];
        EXPECT_EQ(a.crossings, b.crossings);
        EXPECT_EQ(a.instance, a.radius > 0.5f ? 0u : 1u);
        EXPECT_EQ(b.instance, shared::kNone);
        EXPECT_EQ(a.primitive, instanced->geometries[1].firstSphere);
        expectNear(a.center, b.center, 2e-6);
        EXPECT_NEAR(a.radius, b.radius, 1e-6);
        EXPECT_EQ(a.inverseEta, b.inverseEta);
        EXPECT_EQ(a.tint, b.tint);
        EXPECT_GT(a.error, 0);
        EXPECT_EQ(b.error, 0);
        for (std::size_t k = 0; k < shared::kReachSteps; ++k) {
            EXPECT_NEAR(a.reach[k].x, b.reach[k].x, 1e-5);
            EXPECT_NEAR(a.reach[k].y, b.reach[k].y, 1e-5);
        }
        EXPECT_NEAR(instanced->casterLights[i].weight / copied->casterLights[i].weight, 1, 1e-5);
    }
    for (const int balls : ways) EXPECT_EQ(balls, 2);
}

// An instance's material replaces those of its surfaces: by glass, by another glass, by what is none.
TEST(SpecularCasters, HaveTheMaterialOfTheInstance) {
    SceneDesc scene = litFloor();
    scene.prototypes["ball"] = {{sphere({0, 0, 0}, 0.5, "glass")}, {beads("matte")}};
    scene.prototypes["stone"] = {{sphere({0, 0, 0}, 0.7, "matte")}, {beads("matte")}};
    for (const char* name : {"ball", "stone"}) {
        add(scene, instanceOf(name, kMirrored, "dense"));
        add(scene, instanceOf(name, kTurned, "matte"));
    }
    const auto compiled = test::connectedThroughAll(*compileScene(scene));
    ASSERT_EQ(compiled->instances.size(), 4u);
    ASSERT_EQ(compiled->specularCasters.size(), shared::kConnectedSpheres);
    std::vector<float> radii;
    for (const shared::SpecularCaster& smooth : compiled->specularCasters) {
        radii.push_back(smooth.radius);
        EXPECT_FLOAT_EQ(smooth.inverseEta, 1 / 1.8f);
        EXPECT_FLOAT_EQ(smooth.tint.x, std::pow(0.9f, float(smooth.crossings + 1)));
        EXPECT_TRUE(smooth.instance == 0 || smooth.instance == 2) << smooth.instance;
    }
    EXPECT_FLOAT_EQ(radii[0], 0.42f);
    EXPECT_FLOAT_EQ(radii[1], 0.3f);
}

// The list stays short, and empty where it would be a small part of all; of a million spheres none is looked at.
TEST(SpecularCasters, OfManyInstancesAreFew) {
    SceneDesc scene = litFloor();
    scene.prototypes["equal"] = {{sphere({0, 0, 0}, 0.02, "glass")}, {beads("matte")}};
    scene.prototypes["few"] = {{sphere({0, 0, 0}, 0.01, "glass")}, {beads("matte")}};
    scene.prototypes["many"] = {{SphereSetDesc{std::vector<glm::dvec3>(1100, glm::dvec3(0)), 0.01, "glass"}}};
    add(scene, sphere({0, 5, 0}, 0.02, "glass"));
    const auto listed = [&scene](const std::string& prototype, int count) {
        SceneDesc filled = scene;
        for (int i = 0; i < count; ++i) {
            const int column = i % 100, row = i / 100;
            add(filled, instanceOf(prototype, {Translate{{0.03 * column, 0, 0.03 * row}}}));
        }
        return test::connectedThroughAll(*compileScene(filled))->specularCasters;
    };
    const std::vector<shared::SpecularCaster> few = listed("few", 1000);
    ASSERT_EQ(few.size(), shared::kConnectedSpheres);
    EXPECT_EQ(few[0].instance, shared::kNone);
    EXPECT_EQ(few[1].instance, shared::kNone);
    EXPECT_EQ(few[2].instance, shared::kNone);
    EXPECT_EQ(few[3].instance, 0u); // below the lamp, of which it sees most
    EXPECT_EQ(listed("equal", 1000).size(), 0u);
    const std::vector<shared::SpecularCaster> many = listed("many", 1000);
    ASSERT_EQ(many.size(), 3u); // it refracts, and reflects outside and inside
    for (const shared::SpecularCaster& smooth : many) EXPECT_EQ(smooth.instance, shared::kNone);
}

// Of a hundred lights those are connected to from which most noise comes: irradiance of the sphere's centre times
// radiance.
TEST(SpecularCasters, ConnectToTheLightsWithMostNoise) {
    constexpr std::uint32_t kLights = 100;
    SceneDesc scene = withMaterials();
    add(scene, sphere({0, 0, 0}, 0.5, "glass"));
    std::vector<std::pair<double, std::uint32_t>> noise;
    std::vector<double> irradiance;
    test::Uniforms uniform(5);
    for (std::uint32_t i = 0; i < kLights; ++i) {
        const std::string name = "lamp " + std::to_string(i);
        const double radiance = uniform.logBetween(1, 100), distance = uniform.logBetween(3, 30), side = 0.2;
        scene.materials[name] = emitter(glm::dvec3(radiance));
        scene.materials[name].sides = Sides::Both;
        add(scene, QuadDesc{{-side / 2, distance, -side / 2}, {side, 0, 0}, {0, 0, side}, name});
        irradiance.push_back(radiance * side * side / (distance * distance));
        noise.emplace_back(irradiance.back() * radiance, i);
    }
    std::ranges::sort(noise, std::greater());
    std::vector<std::uint32_t> expected;
    for (std::size_t i = 0; i < shared::kCasterLights; ++i) expected.push_back(noise[i].second);
    std::ranges::sort(expected);
    const auto compiled = test::connectedThroughAll(*compileScene(scene));
    ASSERT_EQ(compiled->specularCasters.size(), 3u);
    for (const shared::SpecularCaster& smooth : compiled->specularCasters) {
        ASSERT_EQ(smooth.lightCount, shared::kCasterLights);
        for (std::uint32_t i = 0; i < shared::kCasterLights; ++i) {
            const shared::CasterLight& reach = compiled->casterLights[smooth.firstLight + i];
            EXPECT_EQ(reach.light, expected[i]);
            EXPECT_EQ(reach.skyPatch, shared::kNone);
            EXPECT_NEAR(double(reach.weight) / irradiance[reach.light], 1, 1e-5);
        }
    }
}

// Where the lights that a sphere can be connected to are too few to matter, it is not worth the time.
TEST(SpecularCasters, OfManyEqualLightsAreNone) {
    const auto listed = [](int lights) {
        SceneDesc scene = withMaterials();
        add(scene, sphere({0, 0, 0}, 1, "glass"));
        SphereSetDesc lamps{{}, 0.001, "lamp"};
        for (int i = 0; i < lights; ++i) lamps.centers.emplace_back(0.01 * i, 20, 0);
        add(scene, lamps);
        return test::connectedThroughAll(*compileScene(scene))->specularCasters.size();
    };
    EXPECT_EQ(listed(2 * shared::kCasterLights - 1), 3u);
    EXPECT_EQ(listed(2 * shared::kCasterLights + 1), 0u);
}

// Nor are many spheres looked at where there are many lights, however much goes on from one of them.
TEST(SpecularCasters, OfManyUnderManyLightsAreNone) {
    const auto listed = [](std::size_t spheres) {
        SceneDesc scene = withMaterials();
        add(scene, sphere({0, 5, 0}, 1, "glass"));
        add(scene, SphereSetDesc{std::vector<glm::dvec3>(spheres - 1, glm::dvec3(0)), 0.01, "glass"});
        SphereSetDesc lamps{{}, 0.001, "lamp"};
        for (int i = 0; i < 1 << 15; ++i) {
            const int column = i % 128, row = i / 128;
            lamps.centers.emplace_back(0.1 * column, 20, 0.1 * row);
        }
        add(scene, lamps);
        add(scene, SphereSetDesc{{{0, 6.2, 0}}, 0.1, "lamp"}); // brighter than all of them on the first
        return test::connectedThroughAll(*compileScene(scene))->specularCasters.size();
    };
    EXPECT_GT(listed(255), 0u);
    EXPECT_EQ(listed(257), 0u);
}

} // namespace
} // namespace rt::scene
