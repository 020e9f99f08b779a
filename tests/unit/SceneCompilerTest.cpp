#include <gtest/gtest.h>

#include "Common/Scene/BuiltinScenes.h"
#include "Common/Scene/SceneCompiler.h"

namespace rt::scene {
namespace {

TEST(SceneCompiler, FindsEveryLightOfCornellBoxLights) {
    const auto scene = compileScene(findBuiltinScene("cornell-box-lights"));
    EXPECT_EQ(scene->globals.lightCount, 12u);
    EXPECT_EQ(scene->lights.size(), 12u);
    EXPECT_EQ(scene->quads.size(), 14u);
    EXPECT_EQ(scene->spheres.size(), 5u);
    EXPECT_EQ(scene->lights.back().cdf, 1.0f);
    EXPECT_EQ(scene->features, shared::kFeatureSpheres | shared::kFeatureQuads | shared::kFeatureLambertian |
                                   shared::kFeatureDielectric | shared::kFeatureEmissive | shared::kFeatureLights |
                                   shared::kFeatureSphereLights | shared::kFeatureQuadLights);
}

}  // namespace
}  // namespace rt::scene
