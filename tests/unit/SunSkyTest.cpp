// Sun and sky in scenes: where the sun stands, scene files, glTF.
#include <cmath>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Daylight.h"
#include "Common/Scene/Edit/EditCheck.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Shared/Light/Sky.h"
#include "tests/unit/WrittenGltf.h"

namespace rt::scene {
namespace {

using glm::dvec3;

SceneDesc withSky(const std::string& more, const std::string& objects = "") {
    const std::string begin = R"({"materials": {"white": {"type": "lambertian", "albedo": [1, 1, 1]}},
        "background": {"type": "sun_sky")";
    return parseScene(begin + more + R"(}, "objects": [)" + objects + "]}", "sky.json", ".");
}

TEST(SunSky, TheSunStandsWhereACompassSays) {
    for (const auto& [azimuth, place] : {std::pair(0, dvec3(0, 0, -1)), std::pair(90, dvec3(1, 0, 0)),
                                         std::pair(180, dvec3(0, 0, 1)), std::pair(-90, dvec3(-1, 0, 0))}) {
        const SceneDesc scene = withSky(R"(, "sun_elevation": 30, "sun_azimuth": )" + std::to_string(azimuth));
        const auto compiled = compileScene(scene);
        EXPECT_EQ(compiled->globals.skyKind, shared::kSkyImage);
        EXPECT_NE(compiled->globals.skyLight, shared::kNone);
        const shared::SceneView view = shared::viewOf(*compiled, compiled->globals);
        const auto seen = [&](const dvec3& d) {
            return shared::skyRadiance(shared::kFeatureAll, view, shared::vec3(glm::normalize(d))).y;
        };
        const dvec3 sun = std::sqrt(0.75) * place + dvec3(0, 0.5, 0);
        EXPECT_LT(glm::distance(sunDirection(std::get<SunSkyBackground>(scene.background)), sun), 1e-12);
        EXPECT_GT(seen(sun), 1e4f) << azimuth;
        EXPECT_LT(seen(sun + dvec3(0, 0.02, 0)), 10.0f) << azimuth;
        EXPECT_LT(seen({-sun.x, sun.y, -sun.z}), 1.0f) << azimuth;
    }
}

TEST(SunSky, ItsFactorMultiplies) {
    const auto once = compileScene(withSky("")), thrice = compileScene(withSky(R"(, "factor": [3, 3, 3])"));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(thrice->lights[0].emission[c] / once->lights[0].emission[c], 3, 1e-5);
    EXPECT_EQ(compileScene(withSky(R"(, "factor": [0, 0, 0])"))->globals.skyKind, shared::kSkyBlack);
}

TEST(SunSky, SceneFilesKeepEveryBit) {
    const std::string numbers = R"(, "sun_elevation": 12.3456789012345678, "sun_azimuth": -271.1,
        "turbidity": 2.7182818284590452, "ground": [0.1, 0.2, 0.3], "factor": [0.5, 0.25, 0.3])";
    for (const SceneDesc& scene : {withSky(numbers), withSky("")}) {
        const SceneDesc read = parseScene(toJson(scene), "sky.json", ".");
        EXPECT_EQ(read.background, scene.background);
        EXPECT_EQ(compileScene(read)->hash, compileScene(scene)->hash);
    }
    EXPECT_EQ(withSky("").background, Background(SunSkyBackground{}));
}

TEST(SunSky, WhatItCannotBeIsNamed) {
    const auto errorOf = [](const std::string& more) {
        try {
            withSky(more);
        } catch (const InputError& error) {
            return messageOf(error);
        }
        return std::string();
    };
    EXPECT_NE(errorOf(R"(, "sun_elevation": -5)").find("/background/sun_elevation: -5: must be a number from 0 to 90"),
              std::string::npos);
    EXPECT_NE(errorOf(R"(, "turbidity": 1)").find("/background/turbidity: 1: must be a number from 2 to 10"),
              std::string::npos);
    EXPECT_NE(errorOf(R"(, "ground": [2, 0, 0])").find("/background/ground"), std::string::npos);
    EXPECT_NE(errorOf(R"(, "rotation": 3)").find("unknown key \"rotation\""), std::string::npos);
    SunSkyBackground night;
    night.sunElevation = -1;
    EXPECT_THROW(checkEdit(SceneDesc(), SetBackground{night}), InputError);
}

using SunSkyGltf = WrittenGltf;

TEST_F(SunSkyGltf, HasTheSunAsALight) {
    SceneDesc scene = withSky(R"(, "sun_elevation": 30, "factor": [2, 2, 2])",
                              R"({"type": "quad", "corner": [0, 0, 0], "edge_u": [1, 0, 0], "edge_v": [0, 0, 1],
                                  "material": "white"})");
    const SceneDesc read = again(scene, "sun.glb");
    EXPECT_TRUE(isNoticed("the sky but for its sun"));
    const auto& sky = std::get<SunSkyBackground>(scene.background);
    const auto written = compileScene(read);
    ASSERT_EQ(written->lights.size(), 1u);
    EXPECT_LT(glm::distance(dvec3(written->lights[0].normal), -sunDirection(sky)), 1e-5);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(written->lights[0].emission[c] / (2 * Daylight(sky).sun()[c]), 1, 1e-5);
}

} // namespace
} // namespace rt::scene
