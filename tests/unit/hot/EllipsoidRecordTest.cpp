// What the compiler makes of emissive spheres under maps that scale unequally: the record of the light, and its bound.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/matrix.hpp>

#include "Common/Scene/Affine.h"
#include "Common/Scene/Builtin/SceneBuilder.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Shared/Light/LightContribution.h"
#include "tests/unit/Oracles.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {
namespace {

using glm::dmat3;
using glm::dvec3;
using test::randomDirection;
using test::Uniforms;

double exactArea(const dmat3& axes) {
    const dmat3 cofactors = glm::determinant(axes) * glm::transpose(glm::inverse(axes));
    constexpr int kSteps = 600;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k) {
            const double z = 1 - 2 * (i + 0.5) / kSteps, r = std::sqrt(1 - z * z),
                         phi = 2 * std::numbers::pi * (k + 0.5) / kSteps;
            sum += glm::length(cofactors * dvec3(r * std::cos(phi), r * std::sin(phi), z));
        }
    return 4 * std::numbers::pi * sum / (kSteps * kSteps);
}

// Scaled about the axes and by a matrix that shears, in nested groups, from one to 10^4.
TEST(EllipsoidRecords, HoldTheWorldsShape) {
    Uniforms uniform(7);
    for (int i = 0; i < 200; ++i) {
        const dvec3 factors(uniform.logBetween(0.01, 1), uniform.logBetween(0.01, 1), i & 1 ? -1 : 1);
        scene::SceneDesc desc;
        desc.id = "test";
        desc.materials = {{"lamp", scene::emitter({1, 2, 4})}};
        scene::GroupDesc inner, outer;
        const scene::Rotate turn{randomDirection(uniform), uniform.between(0, 360)};
        inner.transform = {turn, scene::Scale{factors}};
        inner.objects.push_back({scene::sphere({0.1, 0.2, 0.3}, 2, "lamp")});
        outer.transform = {scene::Rotate{randomDirection(uniform), 50}, scene::Translate{{1, 2, 3}}};
        outer.objects.push_back({inner});
        desc.objects.push_back({outer});
        const auto compiled = scene::compileScene(desc);
        ASSERT_EQ(compiled->lights.size(), 1u);
        ASSERT_EQ(compiled->instances.size(), 1u);
        EXPECT_TRUE(has(compiled->features, kFeatureEllipsoidLights));
        EXPECT_EQ(compiled->instances[0].light, 0u);
        const Light& light = compiled->lights[0];
        const LightBound& bound = compiled->lightBounds[0];
        ASSERT_EQ(light.kind, kLightEllipsoid);
        const dmat3 axes(light.edgeU, light.edgeV, light.normal);
        EXPECT_NEAR(light.area / exactArea(axes), 1, 0.012);
        EXPECT_NEAR(4 * std::numbers::pi * double(light.radius) * double(light.radius) / light.area, 1, 1e-6);
        EXPECT_NEAR(bound.intensity / (0.25 * light.area * (0.2126 + 2 * 0.7152 + 4 * 0.0722)), 1, 1e-5);
        EXPECT_EQ(bound.axis, vec3(0));
        // The points found by hand, within the bound, and it is no larger than it must be.
        const scene::Affine map = scene::toAffine(outer.transform) * scene::toAffine(inner.transform) *
                                  scene::translation({0.1, 0.2, 0.3}) * scene::scaling(dvec3(2));
        const scene::Affine back = *scene::inverse(map);
        double farthest = 0;
        for (int k = 0; k < 2000; ++k) {
            const dvec3 p = dvec3(light.position) + axes * randomDirection(uniform);
            EXPECT_NEAR(glm::length(back.point(p)), 1, 2e-4);
            farthest = std::max(farthest, glm::length(p - dvec3(bound.center)));
            EXPECT_LE(glm::length(p - dvec3(bound.center)), bound.radius);
        }
        EXPECT_GT(farthest, 0.98 * double(bound.radius));
        // What the tracer meets is the same surface.
        for (int k = 0; k < 100; ++k) {
            const dvec3 p = axes * randomDirection(uniform) + dvec3(light.position);
            dvec3 onSphere;
            for (int row = 0; row < 3; ++row) {
                const vec4 r = compiled->instances[0].toObject[row];
                onSphere[row] = glm::dot(dvec3(r), p) + double(r.w);
            }
            EXPECT_NEAR(glm::length(onSphere), 1, 2e-4);
        }
    }
}

// Wherever light can arrive the estimate by which lights are chosen is positive.
TEST(EllipsoidRecords, AreChosenWhereverTheyContribute) {
    Uniforms uniform(8);
    int dark = 0;
    for (int i = 0; i < 3000; ++i) {
        const dvec3 factors(uniform.logBetween(0.01, 3), uniform.logBetween(0.01, 3), uniform.logBetween(0.01, 3));
        scene::SceneDesc desc;
        desc.id = "test";
        desc.materials = {{"lamp", scene::emitter({1, 1, 1})}};
        scene::GroupDesc group;
        group.transform = {scene::Rotate{randomDirection(uniform), 70}, scene::Scale{factors},
                           scene::Translate{3.0 * randomDirection(uniform)}};
        group.objects.push_back({scene::sphere({0, 0, 0}, 1, "lamp")});
        desc.objects.push_back({group});
        const auto compiled = scene::compileScene(desc);
        ASSERT_EQ(compiled->lights.size(), 1u);
        const Light& light = compiled->lights[0];
        const dmat3 axes(light.edgeU, light.edgeV, light.normal);
        if (glm::length(glm::inverse(axes) * dvec3(light.position)) < 1.0001) continue;
        const vec3 normal(randomDirection(uniform));
        const double exact =
            test::polygonIrradiance(test::ellipsoidOutline(dvec3(light.position), axes), dvec3(normal));
        const float estimate = lightContribution(compiled->lightBounds[0], vec3(0), normal);
        if (exact > 1e-9) {
            ASSERT_GT(estimate, 0.0f) << i;
        }
        ASSERT_GT(lightContribution(compiled->lightBounds[0], vec3(0), vec3(0)), 0.0f) << i;
        dark += estimate == 0 ? 1 : 0;
    }
    EXPECT_GT(dark, 300); // and it does exclude some
}

// An image shows how the sphere was turned, so the map stays as it is, and single precision must invert it.
TEST(EllipsoidRecords, ThatShowImagesKeepTheirMap) {
    const auto compiledWith = [](double flatness) {
        scene::SceneDesc desc;
        desc.id = "test";
        desc.textures["map"] = scene::ImageTexture{"none.jpg", "mars", dvec3(1)};
        scene::MaterialDesc lamp = scene::emitter({1, 1, 1});
        lamp.emissionTexture = "map";
        desc.materials = {{"lamp", lamp}};
        scene::GroupDesc group;
        group.transform = {scene::Rotate{{1, 2, 3}, 40}, scene::Scale{{1, flatness, flatness}},
                           scene::Rotate{{3, 1, 2}, 60}};
        group.objects.push_back({scene::sphere({0, 0, 0}, 1, "lamp")});
        desc.objects.push_back({group});
        scene::CompileOptions options;
        options.generatedAssets = true;
        return scene::compileScene(desc, options);
    };
    const auto usual = compiledWith(0.3);
    ASSERT_EQ(usual->lights.size(), 1u);
    const scene::Affine map =
        scene::toAffine({scene::Rotate{{1, 2, 3}, 40}, scene::Scale{{1, 0.3, 0.3}}, scene::Rotate{{3, 1, 2}, 60}});
    EXPECT_LT(glm::length(dvec3(usual->lights[0].edgeU) - map.linear[0]), 1e-6);
    EXPECT_LT(glm::length(dvec3(usual->lights[0].normal) - map.linear[2]), 1e-6);
    const auto needle = compiledWith(1e-5);
    EXPECT_EQ(needle->lights.size(), 0u);
    EXPECT_EQ(needle->instances.size(), 1u);
    const std::string notice = "1 emissive sphere is scaled so unequally that light sampling leaves it out";
    EXPECT_EQ(std::count(needle->notices.begin(), needle->notices.end(), notice), 1);
}

} // namespace
} // namespace rt::shared
