// What lights are estimated to contribute, by which they are chosen.
#include <functional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Scene/Compiler/LightTable.h"
#include "Common/Shared/Light/LightContribution.h"
#include "tests/unit/LightDraws.h"
#include "tests/unit/LightShapes.h"

namespace rt::shared {
namespace {

using glm::dvec3;
using test::agrees;
using test::Mean;
using test::Uniforms;

// What the scene compiler tells choices of a light.
LightBound boundOf(const Light& light) {
    scene::CompiledScene lit;
    lit.lights = {light};
    scene::finishLights(lit);
    return lit.lightBounds.front();
}

Light randomLight(Uniforms& uniform, double size) {
    const auto inBox = [&](double extent) {
        return dvec3(uniform.between(-extent, extent), uniform.between(-extent, extent),
                     uniform.between(-extent, extent));
    };
    switch (uniform.word() % 3) {
        case 0:
            return sphere(inBox(3), size);
        case 1:
            return quad(inBox(3), inBox(size), inBox(size));
        default: {
            const dvec3 a = inBox(3);
            return triangle(a, a + inBox(size), a + inBox(size));
        }
    }
}

TEST(LightContribution, IsNeverZeroWhereTheLightContributes) {
    Uniforms uniform(8);
    int zero = 0;
    for (int i = 0; i < 100000; ++i) {
        Light light = randomLight(uniform, uniform.logBetween(1e-3, 3));
        if (light.kind == kLightSphere && glm::length(light.position) <= light.radius * 1.0001f) continue;
        const bool oneSided = light.kind != kLightSphere && (i & 1);
        if (oneSided) light.sides = kSidesFront;
        const float contribution = lightContribution(boundOf(light), vec3(0), kLitUp);
        ASSERT_TRUE(isFinite(contribution) && contribution >= 0);
        const bool lit = !oneSided || glm::dot(dvec3(light.normal), -dvec3(light.position)) > 1e-6;
        const double exact = lit ? irradiance(light, dvec3(kLitUp)) : 0;
        if (exact > 1e-9) {
            ASSERT_GT(contribution, 0.0f) << i;
        }
        zero += contribution == 0;
        // In a medium only the dark side is dark.
        const float inMedium = lightContribution(boundOf(light), vec3(0), vec3(0));
        if (lit) {
            ASSERT_GT(inMedium, 0.0f);
        }
    }
    EXPECT_GT(zero, 30000); // and it does exclude lights
}

TEST(LightContribution, IsTheIrradianceOfSmallLights) {
    Uniforms uniform(9);
    for (int i = 0; i < 20000; ++i) {
        Light light = randomLight(uniform, 0.01);
        const dvec3 center(boundOf(light).center);
        if (center.z < 0.1 * glm::length(center) || glm::length(center) < 1) continue;
        if (light.kind != kLightSphere && std::abs(glm::dot(dvec3(light.normal), glm::normalize(center))) < 0.1)
            continue;
        const double exact = irradiance(light, dvec3(kLitUp));
        ASSERT_NEAR(lightContribution(boundOf(light), vec3(0), kLitUp), exact, 0.1 * exact);
    }
}

TEST(LightContribution, ScalesExactly) {
    Uniforms uniform(10);
    for (int i = 0; i < 1000; ++i) {
        const LightBound bound = boundOf(randomLight(uniform, 1));
        LightBound scaled = bound;
        scaled.center *= 0x1p16f, scaled.radius *= 0x1p16f, scaled.intensity *= 0x1p32f;
        ASSERT_EQ(lightContribution(bound, vec3(0), kLitUp), lightContribution(scaled, vec3(0), kLitUp));
    }
}

// Choosing in proportion to the contributions must be worth it: in a room of lights the sum of variances shrinks.
TEST(LightContribution, BeatsChoiceByPower) {
    Uniforms uniform(11);
    std::vector<Light> lights;
    lights.reserve(16);
    for (int i = 0; i < 16; ++i) lights.push_back(randomLight(uniform, 0.3));
    const RenderParams params = withMethod(kShapeAuto);
    const auto variance = [&](const std::function<double(const Light&)>& weight) {
        std::vector<double> weights;
        double total = 0;
        for (const Light& light : lights) total += weights.emplace_back(weight(light));
        Mean mean;
        for (int i = 0; i < 1 << 16; ++i) {
            double x = uniform.between(0, total);
            std::size_t chosen = 0;
            while (chosen + 1 < lights.size() && x >= weights[chosen]) x -= weights[chosen++];
            const LightSample s = sampleLight(kFeatureAll, params, lights[chosen], vec3(0), kLitUp, 0, uniform.pair());
            mean.add(s.pdf > 0 && weights[chosen] > 0 ? double(s.wi.z) / s.pdf * total / weights[chosen] : 0);
        }
        return std::pair(mean, mean.relativeVariance());
    };
    const auto [byContribution, low] =
        variance([](const Light& l) { return double(lightContribution(boundOf(l), vec3(0), kLitUp)); });
    const auto [byPower, high] = variance([](const Light& l) { return double(l.area); });
    double exact = 0;
    for (const Light& light : lights) exact += irradiance(light, dvec3(kLitUp));
    EXPECT_TRUE(agrees(byContribution, exact));
    EXPECT_TRUE(agrees(byPower, exact));
    EXPECT_LT(low * 5, high);
}

} // namespace
} // namespace rt::shared
