// The light table of the scene compiler: geometry, power and bounds of lights, targets, skies.
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Scene/Compiler/LightTable.h"
#include "Common/Shared/Light/Sky.h"
#include "tests/unit/CompilerScenes.h"

namespace rt::scene {
namespace {

using test::kPi;

TEST(SceneLights, LightsHaveTheirWorldGeometry) {
    SceneDesc scene = withMaterials();
    const Transform turn = {Scale{{2, 1, 1}}, Rotate{{1, 1, 1}, 50}, Translate{{1, 2, 3}}};
    add(scene, group(turn, box({0, 0, 0}, {1, 2, 3}, "lamp")));
    MeshData triangle;
    triangle.positions = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}};
    triangle.triangles = {{0, 1, 2}};
    add(scene, group(turn, mesh(triangle, "lamp")));
    add(scene, group({Scale{glm::dvec3(3)}}, sphere({0, 0, 0}, 0.5, "lamp")));
    const auto compiled = compileScene(scene);
    ASSERT_EQ(compiled->globals.lightCount, 8u);
    double area = 0;
    for (std::size_t i = 0; i < 6; ++i) area += compiled->lights[i].area;
    EXPECT_NEAR(area, 2 * (2.0 * 2 + 2.0 * 3 + 2 * 3), 1e-5); // of a box of 2 x 2 x 3
    EXPECT_NEAR(compiled->lights[6].area, 0.5 * 6 * 4, 1e-5);
    EXPECT_NEAR(compiled->lights[7].area, 9 * kPi, 1e-4);
}

TEST(SceneLights, SelectionIsInProportionToPower) {
    SceneDesc scene = withMaterials();
    scene.materials["two-sided"] = emitter(glm::dvec3(1), Sides::Both);
    scene.materials["one-sided"] = emitter(glm::dvec3(1), Sides::Front);
    scene.materials["by flag"] = emitter(glm::dvec3(1));
    scene.materials["dark"] = emitter(glm::dvec3(0));
    for (const char* name : {"two-sided", "one-sided", "by flag", "dark"})
        add(scene, quad({0, 0, 0}, {1, 0, 0}, {0, 2, 0}, name));
    QuadDesc unlisted = quad({0, 0, 0}, {1, 0, 0}, {0, 2, 0}, "two-sided");
    unlisted.light = false;
    add(scene, unlisted);
    add(scene, sphere({0, 0, 0}, 0.5, "by flag"));

    CompileOptions options;
    for (const bool oneSided : {true, false}) {
        options.oneSidedLights = oneSided;
        const auto compiled = compileScene(scene, options);
        ASSERT_EQ(compiled->lights.size(), 4u);
        const double powers[] = {4, 2, oneSided ? 2.0 : 4.0, kPi};
        double sum = 0;
        for (const double power : powers) sum += power;
        for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(compiled->lights[i].selection, powers[i] / sum, 2e-7) << i;
        EXPECT_EQ(compiled->quads[4].light, shared::kNone);
        EXPECT_GT(compiled->materials[compiled->quads[4].material].emission.x, 0);
        EXPECT_EQ(compiled->lights[2].sides, oneSided ? shared::kSidesFront : shared::kSidesBoth);
    }
}

TEST(SceneLights, BoundsHoldTheirLights) {
    const auto compiled = compileScene(findBuiltinScene("many-lights:300"));
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (std::size_t i = 0; i < compiled->lights.size(); ++i) {
        const shared::Light& light = compiled->lights[i];
        const shared::LightBound& bound = compiled->lightBounds[i];
        EXPECT_GT(bound.intensity, 0);
        if (light.kind == shared::kLightSphere) {
            EXPECT_EQ(bound.center, light.position);
            EXPECT_EQ(bound.radius, light.radius);
            EXPECT_EQ(bound.axis, shared::vec3(0));
            continue;
        }
        EXPECT_EQ(bound.axis, light.normal);
        for (int k = 0; k < 50; ++k) {
            double u = uniform(random), v = uniform(random);
            if (light.kind == shared::kLightTriangle && u + v > 1) u = 1 - u, v = 1 - v;
            const glm::dvec3 p = glm::dvec3(light.position) + u * glm::dvec3(light.edgeU) + v * glm::dvec3(light.edgeV);
            EXPECT_LE(glm::length(p - glm::dvec3(bound.center)), bound.radius);
        }
    }
}

TEST(SceneLights, TargetsFollowTheLights) {
    const auto compiled = compileScene(findBuiltinScene("rest-of-life-cornell-box-glass"));
    ASSERT_EQ(compiled->globals.lightCount, 1u);
    ASSERT_EQ(compiled->globals.targetCount, 1u);
    EXPECT_EQ(compiled->lights[1].emission, shared::vec3(0));
    EXPECT_EQ(compiled->lights[1].selection, 0.0f);
    EXPECT_EQ(compiled->lights[1].position, compiled->spheres[0].center);
}

TEST(SceneLights, SkyImagesAreSampledByBrightness) {
    constexpr std::uint32_t width = 8, height = 4;
    CompileOptions options;
    options.loadTexels = [](const std::filesystem::path&, std::optional<std::uint32_t>) {
        TexelData data{width, height, shared::kTexelLinearF32, std::vector<std::uint32_t>(width * height * 3, 0u)};
        const auto set = [&](std::uint32_t x, std::uint32_t y, float value) {
            for (std::uint32_t c = 0; c < 3; ++c) data.words[3 * (y * width + x) + c] = shared::floatBitsToUint(value);
        };
        set(2, 1, 1), set(5, 1, 3), set(7, 2, 4);
        return data;
    };
    SceneDesc scene = withMaterials();
    scene.background =
        ImageBackground{RT_SOURCE_DIR "/Assets/scene.schema.json", glm::dvec3(2)}; // any file that exists
    add(scene, sphere({0, 0, -5}, 1, "matte"));
    add(scene, sphere({0, 0, -5}, 0.001, "lamp"));
    const auto compiled = compileScene(scene, options);
    EXPECT_EQ(compiled->globals.skyKind, shared::kSkyImage);
    ASSERT_EQ(compiled->globals.skyLight, 1u);
    EXPECT_GT(compiled->lights[1].selection, 0.99f);
    EXPECT_EQ(compiled->lights[1].cdf, 1.0f);
    const std::vector<float>& cdf = compiled->skyCdf;
    ASSERT_EQ(cdf.size(), (height + 1) + height * (width + 1));
    // Rows 1 and 2 lie symmetric to the equator and are equally bright; the others are black.
    EXPECT_EQ(cdf[0], 0.0f);
    EXPECT_EQ(cdf[1], 0.0f);
    EXPECT_NEAR(cdf[2], 0.5f, 1e-6);
    EXPECT_EQ(cdf[3], 1.0f);
    EXPECT_EQ(cdf[4], 1.0f);
    const float* row = &cdf[height + 1 + 1 * (width + 1)];
    EXPECT_EQ(row[2], 0.0f);
    EXPECT_NEAR(row[3], 0.25f, 1e-6);
    EXPECT_EQ(row[5], row[3]);
    EXPECT_EQ(row[6], 1.0f);
    EXPECT_EQ(row[width], 1.0f);
    const double meanSine =
        (std::sin(kPi * 1.5 / 4) * 8) / (2 * (std::sin(kPi * 0.5 / 4) + std::sin(kPi * 1.5 / 4)) * 8);
    EXPECT_NEAR(compiled->lights[1].emission.x, 2 * meanSine, 1e-6);

    scene.background = ImageBackground{RT_SOURCE_DIR "/Assets/scene.schema.json", glm::dvec3(0)};
    EXPECT_EQ(compileScene(scene, options)->globals.skyKind, shared::kSkyBlack);
    scene.background = ImageBackground{"none.hdr", glm::dvec3(1)};
    EXPECT_NE(errorOf(scene, options).find("none.hdr: no such file"), std::string::npos);
}

// Four columns, red, green, blue and white from the left, as other tools show them to someone who turns to the right.
TEST(SceneLights, SkyImagesRunToTheRightAsSeenFromInside) {
    constexpr std::uint32_t width = 4, height = 2;
    CompileOptions options;
    options.loadTexels = [](const std::filesystem::path&, std::optional<std::uint32_t>) {
        TexelData data{width, height, shared::kTexelLinearF32, {}};
        for (std::uint32_t y = 0; y < height; ++y)
            for (const float channel : {1, 0, 0, /**/ 0, 1, 0, /**/ 0, 0, 1, /**/ 1, 1, 1})
                data.words.push_back(shared::floatBitsToUint(channel));
        return data;
    };
    SceneDesc scene = withMaterials();
    scene.background = ImageBackground{RT_SOURCE_DIR "/Assets/scene.schema.json", glm::dvec3(1)};
    add(scene, sphere({0, 0, -5}, 1, "matte"));
    const auto compiled = compileScene(scene, options);
    const shared::SceneView view = shared::viewOf(*compiled, compiled->globals);
    const auto seen = [&](float x, float z) {
        return shared::skyRadiance(shared::kFeatureAll, view, glm::normalize(shared::vec3(x, 0.1f, z)));
    };
    // Ahead is -z, to the right of it +x: the image's middle.
    EXPECT_EQ(seen(-0.1f, -1), shared::vec3(1, 0, 0));
    EXPECT_EQ(seen(0.1f, -1), shared::vec3(0, 1, 0));
    EXPECT_EQ(seen(1, -0.1f), shared::vec3(0, 1, 0));
    EXPECT_EQ(seen(1, 0.1f), shared::vec3(0, 0, 1));
    EXPECT_EQ(seen(0.1f, 1), shared::vec3(0, 0, 1));
    EXPECT_EQ(seen(-0.1f, 1), shared::vec3(1, 1, 1));
    EXPECT_EQ(seen(-1, 0.1f), shared::vec3(1, 1, 1));
    EXPECT_EQ(seen(-1, -0.1f), shared::vec3(1, 0, 0));
    // Samples agree with what is seen there, and their density with its evaluation.
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform;
    for (int i = 0; i < 1000; ++i) {
        const shared::LightSample sample = shared::sampleSky(view, {uniform(random), uniform(random)});
        ASSERT_EQ(shared::skyRadiance(shared::kFeatureAll, view, sample.wi), sample.radiance) << i;
        ASSERT_EQ(shared::skyPdf(view, sample.wi), sample.pdf) << i;
    }
}

} // namespace
} // namespace rt::scene
