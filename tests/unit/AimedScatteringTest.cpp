// Scattering that is aimed at a sphere of glass, and the sphere that is chosen for it.
#include <string>

#include <gtest/gtest.h>

#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Shared/Technique/AimedScattering.h"
#include "tests/unit/CompilerScenes.h"
#include "tests/unit/Oracles.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {
namespace {

using glm::dvec3;
using test::agrees;
using test::Mean;
using test::Uniforms;

const vec3 kAlbedo(0.8f, 0.5f, 0.2f);

// A diffuse vertex, and a sphere of sine s = radius / distance, whose centre is at the height rise * s above its
// horizon.
struct AimedConstellation {
    AimedSphere sphere{};
    Vertex v{};
};

AimedConstellation constellation(Uniforms& uniform, double s, double rise) {
    const dvec3 n = randomDirection(uniform);
    const dvec3 t = glm::normalize(glm::cross(n, randomDirection(uniform)));
    const double z = s * rise, distance = uniform.logBetween(1e-2, 1e2);
    AimedConstellation c;
    c.v.origin = vec3(test::inBox(uniform, 1));
    c.v.normal = c.v.shading = vec3(n);
    c.v.bsdf.albedo = kAlbedo;
    c.sphere.center = c.v.origin + vec3((z * n + std::sqrt(1 - z * z) * t) * distance);
    c.sphere.radius = static_cast<float>(s * distance);
    return c;
}

BsdfSample sampled(const AimedConstellation& c, float share, Uniforms& uniform) {
    const BsdfSample b = sampleLambertian(kAlbedo, c.v.shading, uniform.pair());
    return aimScattering(c.sphere, c.v, uniform.pair(), uniform(), share, b);
}

// Under an even sky a surface sends out its albedo, by way of the sphere the share that the sphere is of its view.
TEST(AimedScattering, KeepsTheLightOfAllDirectionsAndOfThoseToTheSphere) {
    Uniforms uniform(1);
    for (const double s : {0.02, 0.2, 0.5, 0.9, 0.99}) {
        for (const double rise : {-0.7, 0.0, 0.5, 1.0, 1.0 / s}) {
            for (const float share : {0.1f, 0.7f}) {
                const AimedConstellation c = constellation(uniform, s, rise);
                const SphereCone cone = aimedCone(c.sphere, c.v.origin);
                Mean all, within, cosines;
                for (int i = 0; i < 1 << 14; ++i) {
                    const BsdfSample b = sampled(c, share, uniform);
                    const double weight = double(b.weight.y / kAlbedo.y), cosine = double(dot(b.wi, c.v.normal));
                    ASSERT_TRUE(weight >= 0 && weight <= 1 / (1 - double(share)) + 1e-5) << s << " " << rise;
                    ASSERT_NEAR(double(b.pdf), std::max(cosine, 0.0) / std::numbers::pi, 1e-6) << s << " " << rise;
                    all.add(weight);
                    within.add(dot(b.wi, cone.axis) > cone.cosine ? weight : 0);
                    cosines.add(weight * cosine);
                }
                const std::string where = std::to_string(s) + " " + std::to_string(rise);
                const dvec3 toCenter = dvec3(c.sphere.center) - dvec3(c.v.origin);
                const double irradiance = test::sphereIrradiance(toCenter, double(c.sphere.radius), dvec3(c.v.normal));
                EXPECT_TRUE(agrees(all, 1, 1e-5)) << where;
                EXPECT_TRUE(agrees(cosines, 2.0 / 3, 1e-5)) << where;
                // Rims of slivers are known to fewer digits.
                EXPECT_TRUE(agrees(within, irradiance / std::numbers::pi, 1e-3)) << where;
            }
        }
    }
}

// What the sample's weight has been divided by is what others ask for, who share what lies in its direction.
TEST(AimedScattering, RatioIsThatOfTheSample) {
    Uniforms uniform(2);
    for (const double s : {0.1, 0.6}) {
        for (const double rise : {0.0, 0.8, 1.2}) {
            const AimedConstellation c = constellation(uniform, s, rise);
            const SphereCone cone = aimedCone(c.sphere, c.v.origin);
            int aimed = 0;
            for (int i = 0; i < 1000; ++i) {
                const BsdfSample b = sampled(c, 0.5f, uniform);
                const float cosine = dot(b.wi, cone.axis);
                if (std::abs(cosine - cone.cosine) < 1e-5f) continue; // at the rim
                aimed += cosine > cone.cosine ? 1 : 0;
                const float ratio = aimedRatio(cone, c.v.normal, 0.5f, b.wi, cosine);
                EXPECT_NEAR(b.weight.x * ratio / kAlbedo.x, 1, 1e-5f) << s << " " << rise;
            }
            EXPECT_GT(aimed, 400) << s << " " << rise;
        }
    }
}

TEST(AimedScattering, WithoutAShareChangesNothing) {
    Uniforms uniform(3);
    for (int i = 0; i < 1000; ++i) {
        const AimedConstellation c = constellation(uniform, uniform.between(0.01, 0.99), uniform.between(-0.9, 1));
        const BsdfSample b = sampleLambertian(kAlbedo, c.v.shading, uniform.pair());
        const BsdfSample same = aimScattering(c.sphere, c.v, uniform.pair(), uniform(), 0.0f, b);
        EXPECT_TRUE(same.wi == b.wi && same.weight == b.weight && same.pdf == b.pdf);
    }
}

// The more light by way of the sphere, the more is aimed; none from behind, from beside what it brings, or within.
TEST(AimedScattering, ShareFollowsFromTheLightThatTheSphereBrings) {
    AimedSphere sphere{};
    sphere.center = vec3(0, 2, 0);
    sphere.radius = 1;
    sphere.axis = vec3(0, -1, 0);
    sphere.gain = 8;
    sphere.limit = 0.8f;
    EXPECT_NEAR(aimedShare(sphere, vec3(0), 2), kMaxAimed / 2, 1e-6f);
    EXPECT_NEAR(aimedShare(sphere, vec3(0), 0), kMaxAimed, 1e-6f);
    EXPECT_LT(aimedShare(sphere, vec3(0, -2, 0), 2), aimedShare(sphere, vec3(0), 2));
    EXPECT_EQ(aimedShare(sphere, vec3(0, 4, 0), 2), 0);
    EXPECT_EQ(aimedShare(sphere, vec3(2, 0.5f, 0), 2), 0);
    EXPECT_GT(aimedShare(sphere, vec3(0, 0.99f, 0), 2), 0);
    for (const vec3 x : {vec3(0, 1.0005f, 0), vec3(0, 1.5f, 0), sphere.center}) EXPECT_EQ(aimedShare(sphere, x, 2), 0);
}

} // namespace
} // namespace rt::shared

namespace rt::scene {
namespace {

// A lamp above a ball. Scattering finds the lamp from the ball's centre with the variance pi d^2 / A - 1.
SceneDesc ballUnderLamp(double side) {
    SceneDesc scene = withMaterials();
    scene.camera.lookFrom = {1, 2, 8};
    add(scene, QuadDesc{{-side / 2, 6, -side / 2}, {side, 0, 0}, {0, 0, side}, "lamp"});
    add(scene, sphere({0, 1, 0}, 0.5, "glass"));
    return scene;
}

// Between what is worth connections and what scattering finds easily.
TEST(AimedScattering, IsForGlassThatIsNotWorthConnections) {
    const auto aimed = [](const SceneDesc& scene) { return compileScene(scene)->globals.aimed; };
    const shared::AimedSphere ball = aimed(ballUnderLamp(2.5)); // 12
    EXPECT_GT(ball.gain, 0);
    EXPECT_EQ(ball.radius, 0.5f);
    EXPECT_NEAR(ball.axis.y, -1, 1e-6);
    EXPECT_TRUE(ball.limit > 0 && ball.limit < 0.95f) << ball.limit;
    EXPECT_EQ(aimed(ballUnderLamp(0.2)).gain, 0); // 2000
    EXPECT_EQ(aimed(ballUnderLamp(8)).gain, 0);   // 0.2
    SceneDesc mirror = ballUnderLamp(2.5);
    mirror.materials["glass"] = metal({0.9, 0.9, 0.9}, 0);
    EXPECT_EQ(aimed(mirror).gain, 0);
    SceneDesc larger = ballUnderLamp(2.5);
    add(larger, sphere({0.5, 1, 2}, 0.8, "glass"));
    EXPECT_EQ(aimed(larger).radius, 0.8f);
}

} // namespace
} // namespace rt::scene
