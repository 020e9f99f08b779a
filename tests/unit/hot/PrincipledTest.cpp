// Principled surfaces: sampling against the density, energy, reciprocity, mirrors as the limit, textures of each
// number.
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Scene/Compiler/DirectionalAlbedos.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Shared/Material/PrincipledSurface.h"
#include "tests/unit/DirectionCells.h"
#include "tests/unit/Oracles.h"
#include "tests/unit/PrincipledSurfaces.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {
namespace {

using glm::dvec3;
using test::bsdfOf;
using test::drawFrom;
using test::evalBothSides;
using test::kPrincipledCases;
using test::kUp;
using test::Mean;
using test::outgoingAt;
using test::PrincipledCase;
using test::principledOf;
using test::Uniforms;

class PrincipledCases : public testing::TestWithParam<PrincipledCase> {};

TEST_P(PrincipledCases, AreSampledAsTheirDensitySays) {
    Uniforms uniform(31);
    for (const float roughness : {0.2f, 0.35f, 0.5f, 0.65f, 0.8f, 1.0f})
        for (const double cosine : {0.95, 0.6, 0.2}) {
            const vec3 wo = outgoingAt(cosine);
            const Bsdf b = bsdfOf(principledOf(GetParam(), roughness), vec3(0.2f, 0.5f, 0.9f), wo);
            const auto density = [&](double u, double v) {
                return double(evalBothSides(b, wo, vec3(test::onSphere(u, v))).w);
            };
            const std::vector<double> expected = test::cellMasses(density);
            const double integral = std::accumulate(expected.begin(), expected.end(), 0.0);
            std::vector<std::uint64_t> counts(expected.size());
            int lost = 0; // below the surface
            constexpr int kSamples = 1 << 14;
            for (int i = 0; i < kSamples; ++i) {
                const BsdfSample s = drawFrom(b, wo, uniform.pair());
                ASSERT_EQ(s.delta, 0u);
                if (!(s.pdf > 0)) {
                    ++lost;
                    continue;
                }
                ++counts[test::cellOf(s.wi)];
                const vec4 f = evalBothSides(b, wo, s.wi);
                ASSERT_NEAR(f.w, s.pdf, 2e-3f * s.pdf) << roughness << ' ' << cosine;
                for (int c = 0; c < 3; ++c) ASSERT_NEAR(s.weight[c] * s.pdf, f[c], 2e-3f * f[c]);
            }
            EXPECT_GT(test::chiSquareP(counts, expected), test::kSignificance) << roughness << ' ' << cosine;
            EXPECT_NEAR(1 - integral, double(lost) / kSamples, 0.01) << roughness << ' ' << cosine;
        }
}

// White surfaces reflect and transmit all light, to the percent that the tables leave.
TEST_P(PrincipledCases, WhiteFurnaceIsWhite) {
    Uniforms uniform(32);
    for (const float roughness : {0.0f, 0.1f, 0.3f, 0.5f, 0.75f, 1.0f})
        for (const double cosine : {1.0, 0.7, 0.4, 0.15}) {
            const vec3 wo = outgoingAt(cosine);
            const Bsdf b = bsdfOf(principledOf(GetParam(), roughness), vec3(1), wo);
            Mean mean;
            for (int i = 0; i < 1 << 14; ++i) mean.add(double(drawFrom(b, wo, uniform.pair()).weight.x));
            // The table of stretched facets is coarser; films are bounded by the channel of which they reflect most.
            const bool isBounded = GetParam().anisotropy > 0 || GetParam().film > 0;
            const double least = isBounded ? 0.93 : 0.988;
            const double most = isBounded ? 1.001 : 1.012;
            const double noise = 4 * mean.standardError();
            EXPECT_GT(mean.mean(), least - noise) << roughness << ' ' << cosine;
            EXPECT_LT(mean.mean(), most + noise) << roughness << ' ' << cosine;
        }
}

// Nothing but numbers, whatever the parameters and however low the direction.
TEST_P(PrincipledCases, AreFiniteEverywhere) {
    Uniforms uniform(33);
    for (int i = 0; i < 100'000; ++i) {
        const float roughness = i % 4 == 0 ? 0.0f : std::pow(uniform(), 3.0f);
        const double cosine = i % 3 == 0 ? std::pow(10.0, uniform.between(-7, 0)) : uniform.between(1e-3, 1);
        const vec3 wo = outgoingAt(cosine);
        const Bsdf b = bsdfOf(principledOf(GetParam(), roughness), vec3(uniform(), 0, 1), wo, i % 2 == 0);
        const BsdfSample s = drawFrom(b, wo, uniform.pair());
        ASSERT_TRUE(isFinite(s.weight) && isFinite(s.pdf) && s.pdf >= 0) << roughness << ' ' << cosine;
        if (s.weight == vec3(0)) continue;
        ASSERT_NEAR(double(dot(s.wi, s.wi)), 1, 1e-4);
        ASSERT_EQ(s.wi.z < 0, s.transmitted != 0);
        const vec4 f = evalBothSides(b, wo, s.wi);
        ASSERT_TRUE(isFinite(vec3(f)) && isFinite(f.w)) << roughness << ' ' << cosine;
    }
}

INSTANTIATE_TEST_SUITE_P(Lobes, PrincipledCases, testing::ValuesIn(kPrincipledCases),
                         [](const auto& info) { return test::principledCaseName(info.param); });

// The lobes themselves, before tables scale them, are those of a physical surface.
TEST(Principled, LobesAreReciprocal) {
    Uniforms uniform(34);
    for (int i = 0; i < 2000; ++i) {
        Bsdf b{};
        b.kind = kMaterialPrincipled;
        b.albedo = vec3(1);
        b.lobes = noLobes();
        b.lobes.others = i % 2 == 0 ? kLobesLayered : kLobesLayered | kLobeStretched;
        b.lobes.rare.stretch = vec2(0.6f, 0.8f);
        b.lobes.rare.stretchedAlpha = vec2(0.7f, 0.15f);
        b.lobes.f0 = vec3(0.2f, 0.5f, 1);
        b.lobes.f90 = vec3(1);
        b.lobes.sheen = vec3(0.3f);
        b.lobes.sheenExponent = 4;
        b.lobes.coat = 0.5f;
        b.lobes.coatAlpha = 0.2f;
        b.lobes.alpha = 0.05f + 0.9f * uniform();
        b.lobes.glass = 1;
        b.lobes.eta = 1 / test::kPrincipledIor;
        const vec3 wo = outgoingAt(uniform.between(0.05, 1)), wi = vec3(test::onSphere(uniform(), uniform()));
        if (std::abs(wi.z) < 0.05f) continue;
        const vec3 there = vec3(evalBothSides(b, wo, wi)) / std::abs(wi.z);
        vec3 back;
        if (wi.z > 0) {
            back = vec3(evalBothSides(b, wi, wo)) / wo.z;
        } else {
            // Radiance is not scaled by the indices, so what comes back differs by their ratio squared.
            b.lobes.eta = test::kPrincipledIor;
            back = vec3(evalBothSides(b, -wi, -wo)) / wo.z * (test::kPrincipledIor * test::kPrincipledIor);
        }
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(there[c], back[c], 1e-3f * there[c] + 1e-5f) << wi.z;
    }
}

// A coat whose normal is bent sends light where the surface below cannot, and the other way round; the density counts
// both. Reflections of the tilted coat that end below the horizon are those of a flat surface turned.
TEST(Principled, CoatsWithANormalOfTheirOwnAreSampledAsTheirDensitySays) {
    Uniforms uniform(36);
    const vec3 tilts[] = {normalize(vec3(0.3f, 0.1f, 1)), normalize(vec3(-0.8f, 0.5f, 0.6f))};
    for (const vec3& coat : tilts)
        for (const float roughness : {0.25f, 0.6f, 1.0f}) {
            Principled p = principledOf(kPrincipledCases[4], roughness);
            const vec3 wo = normalize(vec3(-0.2f, 0.3f, 0.6f));
            const Bsdf b = bsdfOf(p, vec3(0.2f, 0.5f, 0.9f), wo, true, coat);
            const auto reflected = [&](const vec3& wi) {
                return evalPrincipledReflection(kFeatureAll, b.lobes, wo, wi);
            };
            const auto density = [&](double u, double v) { return double(reflected(vec3(test::onSphere(u, v))).w); };
            const std::vector<double> expected = test::cellMasses(density);
            std::vector<std::uint64_t> counts(expected.size());
            int below = 0;
            for (int i = 0; i < 1 << 14; ++i) {
                const BsdfSample s = drawFrom(b, wo, uniform.pair());
                ASSERT_EQ(s.delta | s.transmitted, 0u);
                if (!(s.pdf > 0)) continue;
                ++counts[test::cellOf(s.wi)];
                below += s.wi.z < 0 ? 1 : 0;
                const vec4 f = reflected(s.wi);
                ASSERT_NEAR(f.w, s.pdf, 2e-3f * s.pdf) << roughness;
                for (int c = 0; c < 3; ++c) ASSERT_NEAR(s.weight[c] * s.pdf, f[c], 2e-3f * f[c]);
            }
            EXPECT_GT(test::chiSquareP(counts, expected), test::kSignificance) << coat.z << ' ' << roughness;
            if (coat.z < 0.9f) {
                EXPECT_GT(below, 0) << roughness;
            }
        }
}

// A coat alone is the same lobe in whatever frame: turned with all directions it keeps its value.
TEST(Principled, CoatsTurnWithTheirNormal) {
    Uniforms uniform(37);
    Bsdf b{};
    b.kind = kMaterialPrincipled;
    b.lobes = noLobes();
    b.lobes.others = kLobeCoat;
    b.lobes.coat = 0.7f;
    b.lobes.coatShare = 1;
    for (int i = 0; i < 1000; ++i) {
        b.lobes.coatAlpha = 0.05f + 0.9f * uniform();
        b.lobes.coatNormal = kUp;
        const vec3 wo = outgoingAt(uniform.between(0.05, 1)), wi = outgoingAt(uniform.between(0.05, 1));
        const vec4 straight = evalPrincipledReflection(kFeatureAll, b.lobes, wo, wi);
        ASSERT_EQ(straight, evalPrincipledReflection(kFeatureAll & ~kFeatureCoatNormal, b.lobes, wo, wi));
        const Frame frame = makeFrame(vec3(test::onSphere(uniform.between(0.5, 1), uniform())));
        b.lobes.coatNormal = frame.normal;
        const vec4 turned = evalPrincipledReflection(kFeatureAll, b.lobes, toWorld(frame, wo), toWorld(frame, wi));
        for (int c = 0; c < 4; ++c) ASSERT_NEAR(turned[c], straight[c], 2e-3f * straight[c] + 1e-5f) << i;
    }
}

// A lobe that becomes a mirror loses no brightness on the way.
TEST(Principled, MirrorsAreTheLimitOfRoughness) {
    Uniforms uniform(35);
    const float minimum = std::sqrt(kMinAlpha);
    for (const PrincipledCase& which : kPrincipledCases)
        for (const double cosine : {0.9, 0.3}) {
            const vec3 wo = outgoingAt(cosine);
            const vec3 albedo(0.8f, 0.5f, 0.2f);
            Mean below, above;
            const Bsdf mirror = bsdfOf(principledOf(which, 0.999f * minimum), albedo, wo);
            const Bsdf rough = bsdfOf(principledOf(which, 1.001f * minimum), albedo, wo);
            for (int i = 0; i < 1 << 14; ++i) {
                below.add(double(drawFrom(mirror, wo, uniform.pair()).weight.y));
                above.add(double(drawFrom(rough, wo, uniform.pair()).weight.y));
            }
            EXPECT_TRUE(test::agrees(above, below.mean(), 0.01 + 4 * below.standardError())) << which.name;
        }
}

// ---- from scene files ----------------------------------------------------------------------------------------------

// However few digits the number that chose the lobe has left.
TEST(Principled, GlassOfASmallShareReflectsAsMuchAsItShould) {
    const vec3 wo = outgoingAt(0.6);
    PrincipledCase glass{};
    glass.transmission = 1;
    for (const int digits : {0, 4, 8, 12}) {
        Bsdf b = bsdfOf(principledOf(glass, 0.5f), vec3(1), wo);
        b.lobes.glassShare = std::ldexp(1.0f, -digits);
        b.lobes.diffuseShare = 1 - b.lobes.glassShare;
        b.lobes.specularShare = b.lobes.coatShare = 0;
        Uniforms uniform(34);
        double reflected = 0, expected = 0, variance = 0;
        for (int i = 0; i < 1 << 16; ++i) {
            const float cell = std::floor(std::ldexp(uniform(), 24 - digits)); // of the grid that numbers lie on
            const vec2 u(b.lobes.diffuseShare + std::ldexp(cell, -24), uniform());
            const vec2 pick(remapSample(u.x, b.lobes.diffuseShare, 1), u.y);
            const vec3 h = sampleVisibleNormal(wo, b.lobes.alpha, pick);
            const double f = fresnel(dot(wo, h), b.lobes.eta).x;
            expected += f;
            variance += f * (1 - f);
            reflected += proposePrincipled(kFeatureAll, b, wo, u).transmitted == 0;
        }
        EXPECT_NEAR(reflected, expected, 4 * std::sqrt(variance)) << digits;
    }
}

TEST(Principled, ScenesWithoutItHaveNoneOfIt) {
    scene::SceneDesc desc;
    desc.materials["plain"] = {};
    scene::SphereDesc sphere;
    sphere.material = "plain";
    desc.objects.push_back({sphere});
    const auto plain = scene::compileScene(desc, {});
    EXPECT_TRUE(plain->principled.empty());
    EXPECT_TRUE(plain->directionalAlbedos.empty());
    EXPECT_FALSE(has(plain->features, kFeaturePrincipled | kFeatureOpacity));

    desc.materials["plain"].kind = scene::MaterialKind::Principled;
    const auto made = scene::compileScene(desc, {});
    ASSERT_EQ(made->principled.size(), 1u);
    EXPECT_EQ(made->directionalAlbedos.size(), kAlbedoSteps * kAlbedoSteps);
    EXPECT_TRUE(made->glassAlbedos.empty());
    EXPECT_TRUE(has(made->features, kFeaturePrincipled));
    EXPECT_FALSE(has(made->features, kFeatureOpacity));

    desc.materials["other"] = {};
    sphere.material = "other";
    desc.objects.push_back({sphere});
    EXPECT_FALSE(has(scene::compileScene(desc, {})->features, kFeatureOpacity));

    desc.materials["plain"].principled.opacity.factor = 0.5;
    desc.materials["plain"].principled.transmission.factor = 1;
    const auto translucent = scene::compileScene(desc, {});
    EXPECT_TRUE(has(translucent->features, kFeatureOpacity));
    EXPECT_EQ(translucent->glassAlbedos.size(), 2u * kAlbedoSteps * kAlbedoSteps);
}

// Few tables are kept, and those are what would be made again.
TEST(Principled, TablesOfGlassDoNotDependOnThoseBefore) {
    const std::vector<float> first = scene::glassAlbedos(1.5f);
    for (int i = 0; i < 17; ++i) EXPECT_NE(scene::glassAlbedos(1.6f + 0.01f * float(i)), first);
    EXPECT_EQ(scene::glassAlbedos(1.5f), first);
    EXPECT_EQ(scene::glassAlbedos(1.5f), first);
}

// The bit that a normal of the coat's own costs is set where there is one, and by it alone.
TEST(Principled, CoatNormalsAreAFeatureOfTheirOwn) {
    scene::SceneDesc desc;
    scene::ImageTexture map;
    map.file = "none.png";
    map.standIn = "mars";
    desc.textures["map"] = map;
    scene::SphereDesc sphere;
    sphere.material = "m";
    desc.objects.push_back({sphere});
    const auto hasBit = [&](double coat, const char* normals, const char* coatNormals) {
        scene::MaterialDesc& m = desc.materials["m"];
        m.kind = scene::MaterialKind::Principled;
        m.principled.clearcoat.factor = coat;
        m.principled.normalTexture = normals;
        m.principled.clearcoatNormalTexture = coatNormals;
        return has(scene::compileScene(desc, {})->features, kFeatureCoatNormal);
    };
    EXPECT_FALSE(hasBit(1, "", ""));
    EXPECT_FALSE(hasBit(0, "map", "map"));
    EXPECT_TRUE(hasBit(1, "map", ""));
    EXPECT_TRUE(hasBit(0.5, "", "map"));
}

// Light that crosses a distance inside loses what Beer's law says.
TEST(Principled, AttenuationIsAuthoredByColourAndDistance) {
    scene::SceneDesc desc;
    scene::MaterialDesc& m = desc.materials["glass"];
    m.kind = scene::MaterialKind::Principled;
    m.principled.attenuationColor = {0.25, 0.5, 1};
    m.principled.attenuationDistance = 3;
    scene::SphereDesc sphere;
    sphere.material = "glass";
    desc.objects.push_back({sphere});
    const vec3 absorption = scene::compileScene(desc, {})->principled.at(0).absorption;
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(std::exp(-3.0 * double(absorption[c])), m.principled.attenuationColor[c], 1e-6);
}

} // namespace
} // namespace rt::shared
