// Point, spot and directional lights: their samples against formulas in double precision, their entries in the light
// table, and that no choice of a light ever leaves out one that contributes.
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/trigonometric.hpp>

#include "Common/Scene/Compiler/LightTable.h"
#include "Common/Shared/Light/LightSelection.h"
#include "Common/Shared/Light/PunctualLight.h"
#include "Common/Shared/Light/Sky.h"
#include "tests/unit/CompilerScenes.h"
#include "tests/unit/Oracles.h"
#include "tests/unit/Statistics.h"

namespace rt::scene {
namespace {

using glm::dvec3;
using shared::vec3;
using std::numbers::pi;
using test::Uniforms;

// glTF's, by cosines.
double falloff(double angle, double inner, double outer) {
    const double ramp = (std::cos(angle) - std::cos(outer)) / (std::cos(inner) - std::cos(outer));
    return std::pow(std::clamp(ramp, 0.0, 1.0), 2);
}

TEST(PunctualLight, SpotsFallOffAsGltfRecommends) {
    Uniforms uniform(1);
    for (int i = 0; i < 20000; ++i) {
        const double outer = glm::radians(uniform.logBetween(0.5, 90)), inner = uniform.between(0, 0.95) * outer;
        const dvec3 axis = randomDirection(uniform);
        const dvec3 across = glm::normalize(glm::cross(axis, randomDirection(uniform)));
        const double angle = uniform.between(0, 1.2) * outer;
        const shared::Light light = spotLight(dvec3(0), axis, dvec3(1), inner, outer);
        const vec3 w(axis * std::cos(angle) + across * std::sin(angle));
        EXPECT_NEAR(shared::spotFalloff(light, w), falloff(angle, inner, outer), 5e-4)
            << angle << ' ' << inner << ' ' << outer;
    }
}

// Flux: of the selection by power.
TEST(PunctualLight, AreasAreThoseOfTheFlux) {
    EXPECT_EQ(emittingArea(pointLight(dvec3(0), dvec3(1))), 4);
    for (const auto& [inner, outer] : {std::pair(0.0, 30.0), std::pair(20.0, 30.0), std::pair(10.0, 90.0)}) {
        const double a = glm::radians(inner), b = glm::radians(outer);
        constexpr int kSteps = 100000;
        double flux = 0;
        for (int i = 0; i < kSteps; ++i) {
            const double angle = (i + 0.5) * b / kSteps;
            flux += 2 * pi * std::sin(angle) * falloff(angle, a, b) * b / kSteps;
        }
        EXPECT_NEAR(emittingArea(spotLight(dvec3(0), {0, 0, 1}, dvec3(1), a, b)) * pi / flux, 1, 1e-6) << outer;
    }
}

TEST(PunctualLight, SamplesAreTheIrradianceThatArrives) {
    const shared::Light point = pointLight({0, 3, 4}, {3, 2, 1});
    const shared::LightSample s = shared::samplePunctualLight(point, vec3(0), vec3(0, 1, 0));
    EXPECT_EQ(s.pdf, 1.0f);
    EXPECT_NEAR(s.distance, 5, 1e-6);
    expectNear(dvec3(s.wi), {0, 0.6, 0.8}, 1e-6);
    expectNear(dvec3(s.radiance), dvec3(3, 2, 1) / 25.0, 1e-7);
    EXPECT_EQ(shared::samplePunctualLight(point, vec3(0), vec3(0, -1, 0)).pdf, 0.0f);       // below the horizon
    EXPECT_EQ(shared::samplePunctualLight(point, vec3(0), vec3(0)).pdf, 1.0f);              // in a medium
    EXPECT_EQ(shared::samplePunctualLight(point, point.position, vec3(0, 1, 0)).pdf, 0.0f); // nowhere
    const shared::Light spot = spotLight({0, 3, 4}, {0, 0, -1}, {3, 2, 1}, 0.1, 0.2);
    EXPECT_EQ(shared::samplePunctualLight(spot, vec3(0), vec3(0)).pdf, 0.0f); // aside
    const shared::LightSample sun =
        shared::samplePunctualLight(directionalLight({0, -1, 0}, {3, 2, 1}), vec3(9), vec3(0));
    EXPECT_EQ(sun.wi, vec3(0, 1, 0));
    EXPECT_EQ(sun.distance, shared::kInfinity);
    EXPECT_EQ(sun.radiance, vec3(3, 2, 1));
}

TEST(PunctualLight, TransformsMoveAndTurnThem) {
    SceneDesc scene = withMaterials();
    scene.camera.lookFrom = {1, 2, 3};
    add(scene, sphere({0, 0, 0}, 1, "matte"));
    const Transform transform = {Scale{dvec3(5)}, Rotate{{0, 1, 0}, 90}, Translate{{0, 0, 7}}};
    add(scene, group(transform, PointLightDesc{{1, 0, 0}, dvec3(2)}));
    add(scene, group(transform, SpotLightDesc{{1, 0, 0}, {3, 0, 0}, dvec3(2), 10, 20}));
    add(scene, group(transform, DirectionalLightDesc{{3, 0, 0}, dvec3(2)}));
    add(scene, PointLightDesc{{1, 0, 0}, dvec3(0)}); // dark
    const auto compiled = compileScene(scene);
    ASSERT_EQ(compiled->globals.lightCount, 3u);
    EXPECT_TRUE(shared::has(compiled->features, shared::kFeaturePunctualLights));
    EXPECT_TRUE(compiled->notices.empty());
    for (int i : {0, 1}) expectNear(dvec3(compiled->lights[i].position), {-1, -2, -1}, 1e-6); // as the camera sees it
    for (int i : {1, 2}) expectNear(dvec3(compiled->lights[i].normal), {0, 0, -1}, 1e-6);
    for (const shared::Light& light : compiled->lights) EXPECT_EQ(light.emission, vec3(2));
    expectNear(dvec3(compiled->lights[2].position), {-1, -2, -3}, 1e-6); // of the sphere
    EXPECT_NEAR(compiled->lights[2].radius, std::sqrt(3.0), 1e-6);
}

// Each appearance of a prototype has its own, also of one whose surfaces are shared.
TEST(PunctualLight, InstancesHaveThem) {
    SceneDesc scene = withMaterials();
    std::vector<ObjectDesc>& objects = scene.prototypes["lamps"];
    for (int i = 0; i < 100; ++i) objects.push_back({sphere({i, 0, 0}, 0.1, "matte")});
    objects.push_back({PointLightDesc{{0, 1, 0}, dvec3(1)}});
    for (double x : {0.0, 5.0, 9.0}) add(scene, InstanceDesc{"lamps", {Translate{{x, 0, 0}}}, {}});
    const auto compiled = compileScene(scene);
    EXPECT_EQ(compiled->instances.size(), 3u);
    ASSERT_EQ(compiled->lights.size(), 3u);
    EXPECT_EQ(compiled->lights[2].position, vec3(9, 1, 0));
}

TEST(PunctualLight, WithoutAUsablePlaceTheyAreDropped) {
    SceneDesc scene = withMaterials();
    add(scene, group({Scale{dvec3(1e9)}}, PointLightDesc{{1e9, 0, 0}, dvec3(1)}));
    add(scene, group({Matrix{{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}}}, DirectionalLightDesc{{0, 1, 0}, dvec3(1)}));
    const auto compiled = compileScene(scene);
    EXPECT_EQ(compiled->globals.lightCount, 0u);
    ASSERT_EQ(compiled->notices.size(), 1u);
    EXPECT_EQ(compiled->notices[0], "2 lights without a usable position or direction were dropped");
}

// Of all kinds, among spheres, in a scene of the extent 4.
CompiledScene mixedLights(std::uint32_t count, std::uint32_t seed) {
    Uniforms uniform(seed);
    CompiledScene s;
    s.globals.skyLight = shared::kNone;
    for (std::uint32_t i = 0; i < count; ++i) {
        const dvec3 emission(uniform.logBetween(1e-2, 1e2));
        switch (i % 8) {
            case 0:
                s.lights.push_back(directionalLight(randomDirection(uniform), 0.1 * emission));
                break;
            case 1: {
                shared::Sphere sphere{};
                sphere.center = vec3(inBox(uniform, 4));
                sphere.radius = 0.1f;
                sphere.power = shared::kInfinity;
                s.lights.push_back(sphereLight(sphere, vec3(0)));
                s.lights.back().emission = vec3(emission);
                break;
            }
            case 2:
            case 3:
                s.lights.push_back(pointLight(inBox(uniform, 4), emission));
                break;
            default: {
                const double outer = glm::radians(uniform.between(5, 90));
                s.lights.push_back(
                    spotLight(inBox(uniform, 4), randomDirection(uniform), emission, 0.5 * outer, outer));
            }
        }
    }
    Bounds bounds;
    bounds.add(dvec3(0), 4);
    placeDirectionalLights(bounds, s);
    finishLights(s);
    return s;
}

class PunctualChoice : public testing::TestWithParam<std::uint32_t> {};

TEST_P(PunctualChoice, NeverLeavesOutALightThatContributes) {
    const CompiledScene s = mixedLights(GetParam(), 2);
    const auto scene = shared::viewOf(s, s.globals);
    Uniforms uniform(3);
    int contributing = 0;
    for (int k = 0; k < 2000; ++k) {
        shared::LightContext context{};
        context.position = vec3(inBox(uniform, 4));
        context.normal = k % 5 == 0 ? vec3(0) : vec3(randomDirection(uniform));
        constexpr std::uint32_t kPolicy = shared::kSelectContribution;
        shared::chooseLight(shared::kFeatureAll, scene, kPolicy, s.globals.lightCount, uniform.pair(), context);
        for (std::uint32_t i = 0; i < s.globals.lightCount; ++i) {
            if (!shared::isPunctual(shared::kFeatureAll, s.lights[i])) continue;
            const shared::LightSample sampled =
                shared::samplePunctualLight(s.lights[i], context.position, context.normal);
            // Grazing light is worth nothing.
            const float cosine = shared::isSurface(context.normal) ? dot(context.normal, sampled.wi) : 1.0f;
            if (!(sampled.pdf > 0 && cosine > 1e-6f && shared::maxComponent(sampled.radiance) > 1e-9f)) continue;
            ++contributing;
            EXPECT_GT(shared::lightProbability(shared::kFeatureAll, scene, kPolicy, s.globals.lightCount, i, context),
                      0.0f)
                << i << ", kind " << s.lights[i].kind << ", cosine " << cosine;
        }
    }
    EXPECT_GT(contributing, 2000);
}

// The estimator of next-event estimation over the choice, against the sum over all lights.
TEST_P(PunctualChoice, HasTheSumOfAllLightsAsItsMean) {
    const CompiledScene s = mixedLights(GetParam(), 4);
    const auto scene = shared::viewOf(s, s.globals);
    Uniforms uniform(5);
    for (const std::uint32_t policy : {shared::kSelectUniform, shared::kSelectPower, shared::kSelectContribution}) {
        const vec3 position(inBox(uniform, 3)), normal(randomDirection(uniform));
        const auto irradiance = [&](std::uint32_t i) {
            if (!shared::isPunctual(shared::kFeatureAll, s.lights[i])) return 0.0;
            const shared::LightSample sampled = shared::samplePunctualLight(s.lights[i], position, normal);
            return sampled.pdf > 0 ? double(sampled.radiance.x * dot(normal, sampled.wi)) : 0.0;
        };
        double truth = 0;
        for (std::uint32_t i = 0; i < s.globals.lightCount; ++i) truth += irradiance(i);
        test::Mean mean;
        for (int n = 0; n < 1 << 16; ++n) {
            shared::LightContext context{};
            context.position = position;
            context.normal = normal;
            const shared::LightChoice choice =
                shared::chooseLight(shared::kFeatureAll, scene, policy, s.globals.lightCount, uniform.pair(), context);
            mean.add(choice.light == shared::kNone ? 0 : irradiance(choice.light) / double(choice.probability));
        }
        EXPECT_TRUE(test::agrees(mean, truth)) << policy;
    }
}

INSTANTIATE_TEST_SUITE_P(Counts, PunctualChoice, testing::Values(24u, 60u, 400u));

// As every tool shows an environment image: what is to the right in it is to the right of whoever looks about.
TEST(Sky, IsNotMirroredAsSeenFromInside) {
    using shared::vec3;
    constexpr float kStep = 0.01f;
    for (float azimuth = 0; azimuth < 6.28f; azimuth += 0.1f) {
        const vec3 ahead = glm::normalize(vec3(std::cos(azimuth), 0.3f, std::sin(azimuth))), up(0, 1, 0);
        const vec3 right = glm::normalize(glm::cross(ahead, up));
        const shared::vec2 uv = shared::skyUv(ahead);
        float toTheRight = shared::skyUv(glm::normalize(ahead + kStep * right)).x - uv.x;
        if (toTheRight < -0.5f) toTheRight += 1; // across the image's edge
        EXPECT_GT(toTheRight, 0) << azimuth;
        EXPECT_LT(toTheRight, 2 * kStep / 6.28f) << azimuth;
        EXPECT_LT(shared::skyUv(glm::normalize(ahead + kStep * up)).y, uv.y) << azimuth;
    }
}

// A turned sky looks in the turned direction as it did before, and is sampled there.
TEST(Sky, TurnsAboutTheVertical) {
    constexpr std::uint32_t width = 64, height = 32;
    CompileOptions options;
    options.loadTexels = [](const std::filesystem::path&, std::optional<std::uint32_t>) {
        TexelData data{width, height, shared::kTexelLinearF32, {}};
        Uniforms uniform(6);
        for (std::uint32_t i = 0; i < width * height * 3; ++i)
            data.words.push_back(shared::floatBitsToUint(static_cast<float>(uniform.logBetween(1e-2, 1e2))));
        return data;
    };
    SceneDesc scene = withMaterials();
    add(scene, sphere({0, 0, 0}, 1, "matte"));
    const std::string file = RT_TEST_DATA_DIR "/images/gradient.hdr"; // any file that exists
    const auto compileTurned = [&](double degrees) {
        scene.background = ImageBackground{file, dvec3(1), degrees};
        return compileScene(scene, options);
    };
    const auto plain = compileTurned(0);
    for (const double degrees : {30.0, -200.0}) {
        const auto turned = compileTurned(degrees);
        const auto before = shared::viewOf(*plain, plain->globals), after = shared::viewOf(*turned, turned->globals);
        Uniforms uniform(7);
        int differing = 0; // by rounding at the edges of texels
        for (int i = 0; i < 10000; ++i) {
            const dvec3 d = randomDirection(uniform);
            const vec3 original(d), moved(rotatedY(d, degrees));
            differing += shared::skyRadiance(shared::kFeatureAll, before, original) !=
                         shared::skyRadiance(shared::kFeatureAll, after, moved);
            const shared::vec2 u = uniform.pair();
            const shared::LightSample a = shared::sampleSky(before, u), b = shared::sampleSky(after, u);
            expectNear(dvec3(b.wi), rotatedY(dvec3(a.wi), degrees), 1e-6);
            EXPECT_EQ(b.pdf, a.pdf);
            EXPECT_EQ(b.radiance, a.radiance);
            differing += shared::skyPdf(after, b.wi) != b.pdf;
        }
        EXPECT_LE(differing, 5) << degrees;
    }
}

} // namespace
} // namespace rt::scene
