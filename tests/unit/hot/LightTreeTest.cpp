// The tree of many lights: what it says it draws is what it draws, and it never leaves out a light that contributes.
#include <algorithm>
#include <span>

#include "Common/Scene/Compiler/LightTable.h"
#include "Common/Scene/Compiler/LightTree.h"
#include "Common/Shared/Light/LightTree.h"
#include "tests/unit/Oracles.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {
namespace {

using glm::dvec3;
using scene::CompiledScene;
using test::chiSquareP;
using test::kSignificance;
using test::Uniforms;

// Spheres, quads and triangles of very different sizes and powers, some to both sides, in clumps.
CompiledScene randomLights(std::uint32_t count, std::uint32_t seed) {
    Uniforms uniform(seed);
    CompiledScene s;
    s.globals.skyLight = kNone;
    dvec3 clump(0);
    for (std::uint32_t i = 0; i < count; ++i) {
        if (i % 16 == 0) clump = inBox(uniform, 4);
        const dvec3 at = clump + inBox(uniform, 0.5);
        const double size = uniform.logBetween(1e-3, 0.3);
        Light light{};
        if (uniform.word() % 3 == 0) {
            Sphere sphere{};
            sphere.center = vec3(at);
            sphere.radius = static_cast<float>(size);
            sphere.power = shared::kInfinity;
            light = scene::sphereLight(sphere, vec3(0));
        } else if (uniform.word() % 2 == 0) {
            Quad quad{};
            quad.corner = vec3(at);
            quad.edgeU = vec3(inBox(uniform, size)), quad.edgeV = vec3(inBox(uniform, size));
            quad.normal = glm::normalize(glm::cross(quad.edgeU, quad.edgeV));
            light = scene::quadLight(quad);
        } else {
            light = scene::triangleLight(vec3(at), vec3(at + inBox(uniform, size)), vec3(at + inBox(uniform, size)));
        }
        light.sides = uniform.word() % 3 == 0 ? kSidesBoth : kSidesFront;
        light.emission = vec3(static_cast<float>(i % 50 == 7 ? 0 : uniform.logBetween(1e-2, 1e2)));
        s.lights.push_back(light);
    }
    scene::finishLights(s);
    return s;
}

double irradianceOf(const Light& light, const dvec3& position, const dvec3& normal) {
    const dvec3 at = dvec3(light.position) - position;
    if (light.kind == kLightSphere) return test::sphereIrradiance(at, light.radius, normal);
    if (light.sides == kSidesFront && glm::dot(dvec3(light.normal), at) > -1e-6) return 0;
    const dvec3 u(light.edgeU), v(light.edgeV);
    return test::polygonIrradiance(
        light.kind == kLightQuad ? std::vector{at, at + u, at + u + v, at + v} : std::vector{at, at + u, at + v},
        normal);
}

class LightTree : public testing::TestWithParam<std::uint32_t> {};

TEST_P(LightTree, HasEachLightOnceInsideTheBoundsOfAllItsNodes) {
    const CompiledScene s = randomLights(GetParam(), 1);
    std::vector<int> seen(s.lights.size());
    for (std::uint32_t node = 0; node < s.lightNodes.size(); ++node) {
        for (std::uint32_t i = 0; i < kLightNodeChildren; ++i) {
            const LightNode& n = s.lightNodes[node];
            if (n.omnidirectionalIntensity[i] == 0 && n.planarIntensity[i] == 0) continue;
            if (n.child[i] & kLightLeaf) {
                const std::uint32_t light = n.child[i] & ~kLightLeaf;
                ++seen[light];
                EXPECT_EQ(s.lightToLeaf[light], node * kLightNodeChildren + i);
            } else {
                EXPECT_EQ(loadLightNodeParent(viewOf(s, s.globals), n.child[i]), node * kLightNodeChildren + i);
            }
        }
    }
    for (std::uint32_t i = 0; i < seen.size(); ++i) {
        const LightBound& bound = s.lightBounds[i];
        ASSERT_EQ(seen[i], bound.intensity > 0 ? 1 : 0) << i;
        if (!(bound.intensity > 0)) continue;
        for (std::uint32_t place = loadLightNodeParent(viewOf(s, s.globals), s.lightToLeaf[i] / kLightNodeChildren);
             place != kNone; place = loadLightNodeParent(viewOf(s, s.globals), place / kLightNodeChildren)) {
            const LightCluster c =
                loadLightCluster(viewOf(s, s.globals), place / kLightNodeChildren, place % kLightNodeChildren);
            ASSERT_LE(glm::length(dvec3(bound.center) - dvec3(c.center)) + double(bound.radius),
                      double(c.radius) * (1 + 1e-6));
            if (bound.axis == vec3(0) || bound.twoSided > 0) continue;
            ASSERT_GE(glm::dot(dvec3(bound.axis), dvec3(c.axis)), double(c.spreadCosine) - 1e-6);
        }
    }
}

// Over many points: probabilities sum to at most one, and to nearly one where the bounds are not too coarse; a light
// without a chance contributes nothing.
TEST_P(LightTree, NeverLeavesOutALightThatContributes) {
    const CompiledScene s = randomLights(GetParam(), 2);
    Uniforms uniform(3);
    double lost = 0;
    int points = 0;
    int excluded = 0;
    for (int k = 0; k < 200; ++k) {
        const vec3 position = vec3(inBox(uniform, k % 2 == 0 ? 5 : 50));
        const bool medium = k % 10 == 9;
        const vec3 normal = medium ? vec3(0) : glm::normalize(vec3(inBox(uniform, 1)));
        double sum = 0;
        for (std::uint32_t i = 0; i < s.lights.size(); ++i) {
            const float p = treeProbability(viewOf(s, s.globals), i, position, normal);
            ASSERT_TRUE(isFinite(p) && p >= 0);
            sum += double(p);
            excluded += p == 0;
            if (p > 0 || medium || !(s.lightBounds[i].intensity > 0)) continue;
            const double d = glm::length(dvec3(s.lights[i].position - position));
            if (s.lights[i].kind == kLightSphere && d < double(s.lights[i].radius) * 1.0001) continue;
            const double maximum = double(s.lights[i].area) / (d * d);
            ASSERT_LE(irradianceOf(s.lights[i], dvec3(position), dvec3(normal)), 1e-5 * maximum) << i;
        }
        ASSERT_LE(sum, 1 + 1e-4);
        if (!(sum > 0)) continue;
        lost += 1 - sum;
        ++points;
    }
    EXPECT_GT(excluded, 0);
    EXPECT_LE(lost / points, 0.05);
}

TEST_P(LightTree, DrawsWithTheProbabilitiesItStates) {
    const CompiledScene s = randomLights(GetParam(), 4);
    Uniforms uniform(5);
    for (int k = 0; k < 6; ++k) {
        const vec3 position = vec3(inBox(uniform, k < 3 ? 4 : 40));
        const vec3 normal = k == 2 ? vec3(0) : glm::normalize(vec3(inBox(uniform, 1)));
        std::vector<std::uint64_t> counts(s.lights.size() + 1);
        std::vector<double> weights(s.lights.size() + 1);
        double sum = 0;
        for (std::uint32_t i = 0; i < s.lights.size(); ++i) {
            weights[i] = double(treeProbability(viewOf(s, s.globals), i, position, normal));
            sum += weights[i];
        }
        weights.back() = std::max(0.0, 1 - sum); // descents that end where nothing contributes
        for (int n = 0; n < 1 << 18; ++n) {
            const TreeChoice choice = chooseFromTree(viewOf(s, s.globals), uniform.pair(), position, normal);
            ++counts[choice.light == kNone ? s.lights.size() : choice.light];
            if (choice.light == kNone) continue;
            ASSERT_NEAR(choice.probability, weights[choice.light], 2e-6 * weights[choice.light]);
        }
        EXPECT_GT(chiSquareP(counts, weights), kSignificance) << "point " << k;
    }
}

INSTANTIATE_TEST_SUITE_P(Lights, LightTree, testing::Values(33u, 100u, 1000u, 20000u));

// A planted fault of 2 % in one probability is found.
TEST(LightTreePower, ChiSquareSeesTwoPercent) {
    const CompiledScene s = randomLights(40, 4);
    Uniforms uniform(5);
    std::vector<std::uint64_t> counts(s.lights.size() + 1);
    std::vector<double> weights(s.lights.size() + 1);
    for (std::uint32_t i = 0; i < s.lights.size(); ++i)
        weights[i] = double(treeProbability(viewOf(s, s.globals), i, vec3(3, 1, 0), vec3(0, 0, 1)));
    weights.back() = 1e-12;
    for (int n = 0; n < 1 << 20; ++n) {
        const TreeChoice choice = chooseFromTree(viewOf(s, s.globals), uniform.pair(), vec3(3, 1, 0), vec3(0, 0, 1));
        ++counts[choice.light == kNone ? s.lights.size() : choice.light];
    }
    weights.back() = double(counts.back()) / (1 << 20);
    *std::max_element(weights.begin(), weights.end()) *= 1.02;
    EXPECT_LT(chiSquareP(counts, weights), kSignificance);
}

// The sky is a child of the root, whatever else shines, and is drawn as stated.
TEST(LightTree, HoldsTheSky) {
    CompiledScene s = randomLights(200, 8);
    s.lightBounds.clear(), s.lightNodes.clear(), s.lightToLeaf.clear();
    Light sky{};
    sky.kind = kLightSky;
    sky.sides = kSidesBoth;
    sky.radius = 10;
    sky.area = 4 * kPi * 100;
    sky.emission = vec3(0.01f);
    s.globals.skyLight = 200;
    s.lights.push_back(sky);
    scene::finishLights(s);
    EXPECT_EQ(s.lightToLeaf[200], 0u);
    Uniforms uniform(9);
    for (int k = 0; k < 4; ++k) {
        const vec3 position = vec3(inBox(uniform, 4)), normal = glm::normalize(vec3(inBox(uniform, 1)));
        std::vector<std::uint64_t> counts(2);
        const double probability = double(treeProbability(viewOf(s, s.globals), 200, position, normal));
        EXPECT_GT(probability, 0.0);
        for (int n = 0; n < 1 << 16; ++n)
            ++counts[chooseFromTree(viewOf(s, s.globals), uniform.pair(), position, normal).light == 200];
        EXPECT_GT(chiSquareP(counts, {1 - probability, probability}), kSignificance) << k;
    }
}

TEST(LightTree, OfLightsInOnePlaceAndOfDarkOnes) {
    CompiledScene s;
    s.globals.skyLight = kNone;
    for (int i = 0; i < 200; ++i) {
        Sphere sphere{};
        sphere.radius = 0.1f;
        sphere.power = shared::kInfinity;
        Light light = scene::sphereLight(sphere, vec3(0));
        light.emission = vec3(i < 100 ? 1.0f : 0.0f);
        s.lights.push_back(light);
    }
    scene::finishLights(s);
    for (std::uint32_t i = 0; i < 200; ++i)
        EXPECT_NEAR(treeProbability(viewOf(s, s.globals), i, vec3(0, -1, 0), vec3(0, 1, 0)), i < 100 ? 0.01 : 0.0,
                    1e-6);
    EXPECT_EQ(chooseFromTree(viewOf(s, s.globals), vec2(0.5f), vec3(0, -1, 0), vec3(0, -1, 0)).light,
              kNone); // all below the horizon
}

TEST(LightTree, ScalesExactly) {
    CompiledScene s = randomLights(500, 6);
    CompiledScene scaled = s;
    const float k = 0x1p14f;
    for (Light& light : scaled.lights) {
        light.position *= k, light.edgeU *= k, light.edgeV *= k, light.radius *= k, light.area *= k * k;
    }
    scaled.lightBounds.clear(), scaled.lightNodes.clear(), scaled.lightToLeaf.clear();
    scene::finishLights(scaled);
    Uniforms uniform(7);
    for (int i = 0; i < 2000; ++i) {
        const vec3 position = vec3(inBox(uniform, 6));
        const vec2 u = uniform.pair();
        const TreeChoice a = chooseFromTree(viewOf(s, s.globals), u, position, vec3(0, 1, 0));
        const TreeChoice b = chooseFromTree(viewOf(scaled, scaled.globals), u, position * k, vec3(0, 1, 0));
        ASSERT_EQ(a.light, b.light);
        ASSERT_EQ(a.probability, b.probability);
    }
}

} // namespace
} // namespace rt::shared
