// What a render needs beyond its scene.
#include <gtest/gtest.h>

#include "Common/App/Session/RenderParams.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Shared/Base/Features.h"

namespace rt::app {
namespace {

// Features of a render of a lamp and a ball of this material.
shared::Features featuresWith(const std::string& material, const RenderSettings& settings = {}) {
    const std::string text = R"({"version": 1, "camera": {"look_from": [0, 0, 5], "look_at": [0, 0, 0]},
        "materials": {"lamp": {"type": "emitter", "emission": [1, 1, 1]}, "ball": )" +
                             material + R"(},
        "objects": [{"type": "quad", "corner": [-1, 3, -1], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2], "material": "lamp"},
                    {"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "ball"}]})";
    const auto scene = compile(scene::parseScene(text, "test.json", {}), false);
    return renderFeatures(*scene, scene->camera, settings);
}

TEST(RenderParams, LightSamplingIsLeftOutWhereNothingScattersWidely) {
    constexpr shared::Features kLights = shared::kFeatureLights | shared::kFeatureQuadLights;
    for (const char* material : {R"({"type": "dielectric", "ior": 1.5})", R"({"type": "metal", "albedo": [1, 1, 1]})",
                                 R"({"type": "emitter", "emission": [1, 1, 1]})"}) {
        EXPECT_FALSE(shared::has(featuresWith(material), kLights)) << material;
        RenderSettings all;
        all.features = shared::kFeatureAll;
        EXPECT_EQ(featuresWith(material, all), shared::kFeatureAll) << material;
    }
    for (const char* material :
         {R"({"type": "lambertian", "albedo": [1, 1, 1]})", R"({"type": "metal", "albedo": [1, 1, 1], "fuzz": 0.5})"}) {
        EXPECT_EQ(featuresWith(material) & kLights, kLights) << material;
    }
}

std::uint32_t rouletteOf(const char* scene, bool isOn = true) {
    RenderSettings settings;
    settings.russianRoulette = isOn;
    return makeRenderParams(*compile(loadScene(scene), false), settings).russianRoulette;
}

TEST(RenderParams, RouletteIsThatOfRoomsSkiesOrManyLamps) {
    for (const char* room : {"cornell-box-lights", "many-lights:20", "triangle-lights", "furnace"})
        EXPECT_EQ(rouletteOf(room), 2u) << room;
    EXPECT_EQ(rouletteOf("many-lights:200"), 1u);
    for (const char* plain : {"one-weekend-final", "lucy-in-one-weekend"}) EXPECT_EQ(rouletteOf(plain), 4u) << plain;
    EXPECT_EQ(rouletteOf("cornell-box-lights", false), 0u);
}

} // namespace
} // namespace rt::app
