// Facets that are rougher along one direction: their distribution, its sampling, energy, and where the direction lies.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Shared/Material/PrincipledSurface.h"
#include "tests/unit/DirectionCells.h"
#include "tests/unit/Oracles.h"
#include "tests/unit/PrincipledSurfaces.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {
namespace {

using test::bsdfOf;
using test::drawFrom;
using test::kUp;
using test::PrincipledCase;
using test::principledOf;
using test::Uniforms;

PrincipledCase brushed(float metallic, float strength) {
    PrincipledCase made{};
    made.metallic = metallic;
    made.anisotropy = strength;
    return made;
}

vec3 turned(double cosine, double turn) {
    const double sine = std::sqrt((1 - cosine) * (1 + cosine));
    return vec3(float(sine * std::cos(turn)), float(sine * std::sin(turn)), float(cosine));
}

// What white facets send out of light that arrives from everywhere alike, compensated as they are; by a quadrature over
// visible normals in doubles.
double sentOutByStretched(const PrincipledLobes& lobes, const vec3& wo) {
    const vec2 alpha = lobes.rare.stretchedAlpha;
    const vec3 o = toStretch(lobes.rare.stretch, wo);
    const auto lambda = [&](const vec3& w) {
        const double x = double(w.x) * double(alpha.x), y = double(w.y) * double(alpha.y), z = double(w.z);
        return 0.5 * (std::sqrt(1 + (x * x + y * y) / (z * z)) - 1);
    };
    constexpr int kHeights = 80, kTurns = 80;
    double sum = 0;
    for (int i = 0; i < kHeights; ++i)
        for (int k = 0; k < kTurns; ++k) {
            const double t = (i + 0.5) / kHeights;
            const vec2 u(float(t * t * (3 - 2 * t)), float((k + 0.5) / kTurns));
            const vec3 h = sampleGgxCap(o, alpha, 1, u);
            const double c = std::min(double(dot(o, h)), 1.0);
            const vec3 wi = h * float(2 * c) - o;
            if (!(c > 0 && wi.z > 0)) continue;
            const double f = double(lobes.f0.x) + double(lobes.f90.x - lobes.f0.x) * std::pow(1 - c, 5);
            sum += 6 * t * (1 - t) * f * (1 + lambda(o)) / (1 + lambda(o) + lambda(wi));
        }
    return double(lobes.diffuse.x) + sum / (kHeights * kTurns);
}

TEST(Stretched, NothingMakesEnergy) {
    double least = 1;
    for (const float metallic : {0.0f, 1.0f})
        for (const float strength : {0.05f, 0.2f, 0.5f, 0.8f, 1.0f})
            for (const float roughness : {0.0f, 0.05f, 0.2f, 0.5f, 0.8f, 1.0f})
                for (const double cosine : {1e-3, 0.015, 0.06, 0.25, 0.7, 1.0})
                    for (const double turn : {0.0, 0.35, 0.9, 1.4, 1.5707}) {
                        const vec3 wo = turned(cosine, turn + 0.4); // the direction lies at 0.4
                        const Bsdf b = bsdfOf(principledOf(brushed(metallic, strength), roughness), vec3(1), wo);
                        if (!hasLobe(b.lobes.others, kLobeStretched)) continue;
                        const double sent = sentOutByStretched(b.lobes, wo);
                        EXPECT_LE(sent, 1.001)
                            << metallic << ' ' << strength << ' ' << roughness << ' ' << cosine << ' ' << turn;
                        if (cosine > 0.2 && sent < least) least = sent;
                    }
    EXPECT_GT(least, 0.93);
}

// The density of normals, projected, integrates to 1, whatever the widths; equal widths are the isotropic one.
TEST(Stretched, DistributionIsOne) {
    for (const vec2 alpha : {vec2(1, 0.1f), vec2(0.5f, 0.2f), vec2(0.3f, 0.3f)}) {
        constexpr int kHeights = 2000, kTurns = 400;
        double sum = 0;
        for (int i = 0; i < kHeights; ++i)
            for (int k = 0; k < kTurns; ++k) {
                const double z = (i + 0.5) / kHeights;
                const vec3 h = turned(z, 2 * test::kPi * (k + 0.5) / kTurns);
                sum += double(stretchedDensity(h, alpha)) * z * 2 * test::kPi / (kHeights * kTurns);
            }
        EXPECT_NEAR(sum, 1, 2e-3) << alpha.x << ' ' << alpha.y;
    }
    Uniforms uniform(41);
    for (int i = 0; i < 1000; ++i) {
        const float alpha = 0.01f + 0.99f * uniform();
        const vec3 a = turned(uniform.between(0.01, 1), 6.28 * double(uniform()));
        const vec3 b = turned(uniform.between(0.01, 1), 6.28 * double(uniform()));
        const auto isNear = [](float x, float y) { return std::abs(x - y) <= 1e-4f * y; };
        EXPECT_TRUE(isNear(stretchedDensity(a, vec2(alpha)), ggxDensity(a, alpha)));
        EXPECT_TRUE(isNear(stretchedVisibility(a, b, vec2(alpha)), smithVisibility(a.z, b.z, alpha)));
        EXPECT_TRUE(isNear(stretchedJacobian(a, vec2(alpha)), reflectionJacobian(a, alpha)));
    }
}

// Reflections spread along the direction, whatever the frame: from the front, from the back, rotated, by a texture.
TEST(Stretched, SpreadLiesAlongTheDirection) {
    for (const float facing : {1.0f, -1.0f})
        for (const float rotation : {0.0f, 0.7f, 2.0f}) {
            Principled p = principledOf(brushed(1, 0.9f), 0.15f);
            p.stretch = vec2(std::cos(rotation), std::sin(rotation));
            Surface surface{};
            surface.tangent = vec4(0, 1, 0, 1); // the bitangent is -x
            const vec3 n(0, 0, facing);
            PrincipledValues values = principledValues(kFeatureAll, test::principledTables(1.5f), p, surface);
            addAnisotropy(kFeatureAll, test::principledTables(1.5f), p, surface, n, facing, values);
            ASSERT_TRUE(hasLobe(values.others, kLobeStretched));
            const Frame frame = makeFrame(n);
            const vec3 along = frame.tangent * values.rare.stretch.x + frame.bitangent * values.rare.stretch.y;
            const vec3 expected(-std::sin(rotation), std::cos(rotation), 0);
            EXPECT_NEAR(std::abs(dot(along, expected)), 1, 1e-5) << facing << ' ' << rotation;
            EXPECT_NEAR(along.z, 0, 1e-6);
            // A surface without texture coordinates has no such direction.
            surface.tangent = vec4(0, 0, 0, 0);
            values = principledValues(kFeatureAll, test::principledTables(1.5f), p, surface);
            addAnisotropy(kFeatureAll, test::principledTables(1.5f), p, surface, n, facing, values);
            EXPECT_FALSE(hasLobe(values.others, kLobeStretched));
        }
    Uniforms uniform(42);
    const Bsdf b = bsdfOf(principledOf(brushed(1, 0.9f), 0.15f), vec3(1), kUp);
    double along = 0, across = 0;
    for (int i = 0; i < 4000; ++i) {
        const vec3 wi = toStretch(vec2(std::cos(0.4f), std::sin(0.4f)), drawFrom(b, kUp, uniform.pair()).wi);
        along += double(wi.x * wi.x);
        across += double(wi.y * wi.y);
    }
    EXPECT_GT(along, 20 * across);
}

} // namespace
} // namespace rt::shared
