// The bright patches of sky images that connections lead to: which they are, and how they are sampled.
#include <cmath>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "Common/Scene/Compiler/SkyPatches.h"
#include "Common/Shared/Light/SkyPatches.h"
#include "tests/unit/CompilerScenes.h"
#include "tests/unit/SkyImages.h"
#include "tests/unit/Statistics.h"

namespace rt::scene {
namespace {

using shared::SkyPatch;
using shared::uvec2;
using test::Mean;
using test::Uniforms;

constexpr std::uint32_t kWidth = 64, kHeight = 32;

// A sun with a border, one that the edge of the image cuts in two, and dim texels that differ.
const SkyPatch kSun{{10, 8}, {13, 11}}, kLeft{{0, 20}, {1, 22}}, kRight{{63, 20}, {64, 22}};

float twoSuns(std::uint32_t x, std::uint32_t y) {
    if (x == 11 && y == 9) return 900;
    if (shared::isInPatch(kSun, {x, y})) return 100;
    if (shared::isInPatch(kLeft, {x, y})) return 500;
    if (shared::isInPatch(kRight, {x, y})) return 400;
    return 0.1f + 0.01f * float((x + 3 * y) % 7);
}

std::shared_ptr<const CompiledScene> ballUnder(const SkyPicture& picture) {
    SceneDesc scene = withMaterials();
    add(scene, sphere({0, 0, -5}, 1, "glass"));
    return compileUnder(picture, scene);
}

double solidAngle(std::uint32_t y) {
    return 2 * test::kPi / kWidth * (std::cos(test::kPi * y / kHeight) - std::cos(test::kPi * (y + 1) / kHeight));
}

TEST(SkyPatches, AreTheSuns) {
    const auto scene = ballUnder({kWidth, kHeight, twoSuns});
    const BrightSky sky = findBrightSky(*scene);
    ASSERT_EQ(sky.patches.size(), 3u);
    const std::vector<SkyPatch> expected = {kSun, kLeft, kRight};
    double all = 0;
    for (std::uint32_t y = 0; y < kHeight; ++y)
        for (std::uint32_t x = 0; x < kWidth; ++x) all += double(twoSuns(x, y)) * solidAngle(y);
    EXPECT_NEAR(sky.irradiance / all, 1, 2e-3);
    for (std::size_t i = 0; i < 3; ++i) {
        const BrightPatch& patch = sky.patches[i];
        EXPECT_EQ(patch.texels.begin, expected[i].begin);
        EXPECT_EQ(patch.texels.end, expected[i].end);
        double irradiance = 0, noise = 0;
        for (std::uint32_t y = patch.texels.begin.y; y < patch.texels.end.y; ++y)
            for (std::uint32_t x = patch.texels.begin.x; x < patch.texels.end.x; ++x) {
                const double radiance = double(twoSuns(x, y));
                irradiance += radiance * solidAngle(y);
                noise += radiance * radiance * solidAngle(y);
            }
        EXPECT_NEAR(patch.irradiance / irradiance, 1, 5e-3);
        EXPECT_NEAR(patch.radiance / (noise / irradiance), 1, 5e-3);
    }
    EXPECT_EQ(scene->skyPatches.size(), 3u);
}

// What is as bright everywhere is one patch, by way of which nothing is worth connecting; a single bright texel that
// little comes from is none.
TEST(SkyPatches, OfEvenSkiesAreWorthNothing) {
    const auto even = ballUnder({kWidth, kHeight, [](std::uint32_t x, std::uint32_t y) {
                                     return x == 5 && y == 0 ? 3.0f : 1.0f + 0.5f * float((x + y) % 2);
                                 }});
    EXPECT_EQ(even->specularCasters.size(), 0u);
    EXPECT_EQ(even->skyPatches.size(), 0u);
    const BrightSky sky = findBrightSky(*even);
    ASSERT_EQ(sky.patches.size(), 1u);
    EXPECT_EQ(sky.patches[0].texels.begin, uvec2(0, 0));
    EXPECT_EQ(sky.patches[0].texels.end, uvec2(kWidth, kHeight));
    const auto spotted = ballUnder({kWidth, kHeight, [](std::uint32_t x, std::uint32_t y) {
                                        return x == 5 && y == 2 ? 11.0f : y < 16 ? 1.0f : 0.01f;
                                    }});
    for (const BrightPatch& patch : findBrightSky(*spotted).patches)
        EXPECT_FALSE(shared::isInPatch(patch.texels, {5, 2}));
}

// Samples fall into texels as often as these are bright, with the density that is asked for, and in the cone that
// bounds the patch.
TEST(SkyPatches, AreSampledByTheirLight) {
    const auto scene = ballUnder({kWidth, kHeight, twoSuns});
    const BrightSky sky = findBrightSky(*scene);
    const shared::SceneView view = shared::viewOf(*scene, scene->globals);
    const shared::Image& image = scene->images[scene->globals.skyImage];
    Uniforms uniform(3);
    for (const BrightPatch& patch : sky.patches) {
        const std::uint32_t columns = patch.texels.end.x - patch.texels.begin.x;
        const std::uint32_t rows = patch.texels.end.y - patch.texels.begin.y;
        std::vector<std::uint64_t> counts(columns * rows, 0);
        std::vector<double> weights(columns * rows, 0.0);
        double solidAngles = 0;
        for (std::uint32_t i = 0; i < counts.size(); ++i) {
            const uvec2 texel = patch.texels.begin + uvec2(i % columns, i / columns);
            const double area = solidAngle(texel.y);
            weights[i] = double(shared::skyPatchPdf(view, image, patch.texels, texel)) * area;
            solidAngles += area;
        }
        double whole = 0;
        for (const double weight : weights) whole += weight;
        EXPECT_NEAR(whole, 1, 1e-4);
        Mean inverse;
        int differing = 0; // by rounding at the edges of texels
        for (int k = 0; k < 100000; ++k) {
            const shared::LightSample s = shared::sampleSkyPatch(view, patch.texels, uniform.pair());
            ASSERT_GT(s.pdf, 0);
            inverse.add(1 / double(s.pdf));
            EXPECT_GE(double(glm::dot(s.wi, patch.axis)), std::cos(patch.angle) - 1e-6);
            const uvec2 texel = shared::skyTexel(image, shared::skyUv(shared::toSkyImage(scene->globals, s.wi)));
            if (!shared::isInPatch(patch.texels, texel)) {
                ++differing;
                continue;
            }
            differing += shared::skyPatchPdf(view, image, patch.texels, texel) != s.pdf;
            differing += shared::skyRadiance(shared::kFeatureAll, view, s.wi) != s.radiance;
            const uvec2 place = texel - patch.texels.begin;
            ++counts[place.y * columns + place.x];
        }
        EXPECT_LE(differing, 30);
        EXPECT_GT(test::chiSquareP(counts, weights), test::kSignificance);
        EXPECT_TRUE(test::agrees(inverse, solidAngles));
    }
}

} // namespace
} // namespace rt::scene
