// The studio that a model without light stands in.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <string>
#include <variant>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Scene/FramingCamera.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/Studio.h"
#include "tests/unit/GltfBuilder.h"
#include "tests/unit/ObjFolder.h"

namespace rt::scene {
namespace {

using glm::dvec3;

Bounds boundsOf(const dvec3& lower, const dvec3& upper) {
    Bounds bounds;
    bounds.add(lower);
    bounds.add(upper);
    return bounds;
}

SceneDesc studioFor(const Bounds& bounds) {
    SceneDesc scene;
    scene.camera = framingCamera(bounds);
    addStudioIfUnlit(scene, bounds);
    return scene;
}

std::vector<QuadDesc> quadsOf(const SceneDesc& scene) {
    std::vector<QuadDesc> quads;
    const auto studio = scene.prototypes.find("studio");
    if (studio == scene.prototypes.end()) return quads;
    for (const ObjectDesc& object : studio->second) quads.push_back(std::get<QuadDesc>(object.shape));
    return quads;
}

bool isLamp(const SceneDesc& scene, const QuadDesc& quad) {
    return scene.materials.at(quad.material).emission != dvec3(0);
}

// A surface of this material, to be looked at.
SceneDesc sceneOf(const MaterialDesc& material) {
    SceneDesc scene;
    scene.materials["m"] = material;
    SphereDesc ball;
    ball.material = "m";
    scene.objects.push_back({ball});
    return scene;
}

TEST(Studio, IsInProportionToTheModel) {
    const dvec3 lower(-0.5, -0.25, -1), upper(0.5, 0.25, 1), far(3, -7, 2);
    const std::vector<QuadDesc> one = quadsOf(studioFor(boundsOf(lower, upper)));
    ASSERT_EQ(one.size(), 4u); // three soft boxes and a floor
    for (const double size : {1e-3, 10.0, 1e5}) {
        const std::vector<QuadDesc> quads = quadsOf(studioFor(boundsOf(size * (lower + far), size * (upper + far))));
        ASSERT_EQ(quads.size(), one.size());
        for (std::size_t i = 0; i < one.size(); ++i) {
            EXPECT_NEAR(glm::length(quads[i].corner / size - far - one[i].corner), 0, 1e-10) << size;
            EXPECT_NEAR(glm::length(quads[i].edgeU / size - one[i].edgeU), 0, 1e-10) << size;
            EXPECT_NEAR(glm::length(quads[i].edgeV / size - one[i].edgeV), 0, 1e-10) << size;
        }
    }
}

std::vector<dvec3> cornersOf(const QuadDesc& quad) {
    return {quad.corner, quad.corner + quad.edgeU, quad.corner + quad.edgeV, quad.corner + quad.edgeU + quad.edgeV};
}

// Whether all points lie beyond one side of a picture that is twice as wide as high.
bool isOutOfSight(const CameraDesc& camera, const std::vector<dvec3>& points) {
    const dvec3 forward = glm::normalize(camera.lookAt - camera.lookFrom);
    const dvec3 right = glm::normalize(glm::cross(forward, camera.up)), up = glm::cross(right, forward);
    const double half = std::tan(glm::radians(camera.verticalFov / 2));
    const dvec3 sides[] = {up - half * forward, -up - half * forward, right - 2 * half * forward,
                           -right - 2 * half * forward};
    return std::any_of(std::begin(sides), std::end(sides), [&](const dvec3& side) {
        return std::all_of(points.begin(), points.end(),
                           [&](const dvec3& point) { return glm::dot(point - camera.lookFrom, side) > 0; });
    });
}

TEST(Studio, BoxesFaceTheModelOutOfSightAndTheFloorIsBelow) {
    const Bounds boxes[] = {boundsOf({-1, -1, -1}, {1, 1, 1}), boundsOf({0, 0, 0}, {9, 1e-3, 9}),
                            boundsOf({-1, 0, 0}, {1, 0, 0}),   boundsOf({0, -30, 0}, {1, 30, 1}),
                            boundsOf({2, 3, 4}, {2, 3, 4}),    Bounds{}};
    for (const Bounds& bounds : boxes) {
        const SceneDesc scene = studioFor(bounds);
        const double radius = bounds.empty() ? 1 : bounds.radius();
        for (const QuadDesc& quad : quadsOf(scene)) {
            const dvec3 normal = glm::normalize(glm::cross(quad.edgeU, quad.edgeV));
            if (!isLamp(scene, quad)) {
                EXPECT_LT(glm::length(normal - dvec3(0, 1, 0)), 1e-12);
                EXPECT_LT(quad.corner.y, bounds.empty() ? 0 : bounds.lower.y);
                continue;
            }
            // Its front is towards the model, which it does not touch.
            EXPECT_GT(glm::dot(bounds.center() - quad.corner, normal), 2 * radius) << quad.material;
            EXPECT_TRUE(bounds.empty() || isOutOfSight(scene.camera, cornersOf(quad))) << quad.material;
        }
        // What a scene file may have, whatever the bounds are.
        EXPECT_EQ(parseScene(toJson(scene), "a.json", {}).prototypes, scene.prototypes);
    }
}

// By summing the sky over directions.
TEST(Studio, TheFloorFarAwayIsAsBrightAsTheHorizon) {
    const SceneDesc scene = studioFor(boundsOf({-1, -1, -1}, {1, 1, 1}));
    const auto& sky = std::get<GradientBackground>(scene.background);
    EXPECT_EQ(sky.top.r, sky.top.g);
    EXPECT_EQ(sky.top.r, sky.top.b);
    EXPECT_GE(sky.bottom.r, 0);
    constexpr int kSteps = 100000;
    double received = 0; // over pi, on what faces up
    for (int i = 0; i < kSteps; ++i) {
        const double height = (i + 0.5) / kSteps;
        received += 2 * height / kSteps * (sky.bottom.r + (sky.top.r - sky.bottom.r) * 0.5 * (height + 1));
    }
    const double albedo = std::get<dvec3>(scene.materials.at("studio floor").albedo).r;
    EXPECT_NEAR(albedo * received, 0.5 * (sky.bottom.r + sky.top.r), 1e-6);
}

TEST(Studio, WhatBringsLightNeedsNone) {
    const auto hasStudio = [](SceneDesc scene) {
        addStudioIfUnlit(scene, boundsOf({-1, -1, -1}, {1, 1, 1}));
        return !quadsOf(scene).empty();
    };
    MaterialDesc grey, lamp, glow, pattern, neon;
    lamp.emission = dvec3(0, 1, 0);
    glow.emission = dvec3(0.5);
    pattern.emission = dvec3(1);
    pattern.emissionTexture = "t";
    neon.emission = dvec3(0, 2, 0);
    neon.emissionTexture = "t";
    EXPECT_TRUE(hasStudio({}));
    EXPECT_TRUE(hasStudio(sceneOf(grey)));
    EXPECT_FALSE(hasStudio(sceneOf(lamp)));
    EXPECT_TRUE(hasStudio(sceneOf(glow)));
    EXPECT_TRUE(hasStudio(sceneOf(pattern)));
    EXPECT_FALSE(hasStudio(sceneOf(neon)));
    SceneDesc unlit = sceneOf(lamp);
    std::get<SphereDesc>(unlit.objects[0].shape).light = false;
    EXPECT_TRUE(hasStudio(unlit));
    SceneDesc nested = sceneOf(lamp);
    nested.objects = {{GroupDesc{{}, {{GroupDesc{{}, nested.objects}}}}}};
    EXPECT_FALSE(hasStudio(nested));
    SceneDesc instanced = sceneOf(lamp);
    instanced.prototypes["p"] = std::move(instanced.objects);
    instanced.objects = {{InstanceDesc{"p", {}, {}}}};
    EXPECT_FALSE(hasStudio(instanced));
    for (const ObjectDesc& light :
         {ObjectDesc{PointLightDesc{}}, ObjectDesc{SpotLightDesc{}}, ObjectDesc{DirectionalLightDesc{}}}) {
        SceneDesc scene = sceneOf(grey);
        scene.objects.push_back(light);
        EXPECT_FALSE(hasStudio(scene));
    }
    SceneDesc sky = sceneOf(grey);
    sky.background = GradientBackground{};
    EXPECT_FALSE(hasStudio(sky));
}

TEST(Studio, NoFloorHidesTheModelFromACameraBelow) {
    SceneDesc scene;
    scene.cameras["frog"].lookFrom = dvec3(0, -5, 1);
    addStudioIfUnlit(scene, boundsOf({-1, -1, -1}, {1, 1, 1}));
    EXPECT_EQ(quadsOf(scene).size(), 3u);
}

TEST(Studio, NamesOfTheModelStay) {
    SceneDesc scene;
    scene.materials["studio key"].albedo = dvec3(1, 0, 0);
    scene.prototypes["studio"] = {};
    addStudioIfUnlit(scene, boundsOf({-1, -1, -1}, {1, 1, 1}));
    EXPECT_EQ(std::get<dvec3>(scene.materials.at("studio key").albedo), dvec3(1, 0, 0));
    EXPECT_TRUE(scene.prototypes.at("studio").empty());
    EXPECT_EQ(scene.prototypes.at("studio'").size(), 4u);
}

TEST(Studio, BoundsAreThoseOfAllMeshesWhereTheyStand) {
    MeshData corner;
    corner.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
    corner.triangles = {{0, 1, 2}};
    SceneDesc scene;
    scene.prototypes["p"] = {{MeshDesc{corner, "m"}}};
    scene.objects = {{InstanceDesc{"p", {Translate{{10, 0, 0}}}, {}}},
                     {GroupDesc{{Scale{{1, 3, 1}}}, {{InstanceDesc{"p", {Translate{{0, 0, -5}}}, {}}}}}}};
    const Bounds bounds = boundsOfMeshes(scene);
    EXPECT_EQ(bounds.lower, dvec3(0, 0, -5));
    EXPECT_EQ(bounds.upper, dvec3(11, 6, 0));
    EXPECT_TRUE(boundsOfMeshes({}).empty());
}

class StudioOfFiles : public test::ObjFolder {};

TEST_F(StudioOfFiles, ModelsWithoutLightStandInOneWithANotice) {
    GltfBuilder gltf;
    gltf.addNode({{"mesh", gltf.addMesh(gltf.triangle())}});
    for (const std::filesystem::path& file :
         {write("a.obj", test::kSquare + "f 1 2 3\n"), gltf.save(folder_.path() / "a.glb")}) {
        const SceneDesc scene = app::loadScene(file.string());
        EXPECT_EQ(quadsOf(scene).size(), 4u) << scene.id;
        ASSERT_EQ(scene.notices.size(), 1u) << scene.id;
        EXPECT_NE(scene.notices[0].find("stands in a studio"), std::string::npos) << scene.notices[0];
        const SceneDesc again = parseScene(toJson(scene), "a.json", {});
        EXPECT_EQ(again.prototypes, scene.prototypes);
        EXPECT_EQ(again.background, scene.background);
    }
    write("lamp.mtl", "newmtl lamp\nKe 9 9 9\n");
    const SceneDesc lit =
        app::loadScene(write("b.obj", "mtllib lamp.mtl\nusemtl lamp\n" + test::kSquare + "f 1 2 3\n").string());
    EXPECT_TRUE(quadsOf(lit).empty());
    EXPECT_EQ(lit.background, Background(ConstantBackground{}));
}

} // namespace
} // namespace rt::scene
