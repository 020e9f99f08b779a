#include <algorithm>
#include <numbers>

#include "Common/Shared/Material/Bsdf.h"
#include "tests/unit/Oracles.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {
namespace {

using glm::dvec3;
using test::agrees;
using test::chiSquareP;
using test::kSignificance;
using test::Mean;
using test::Uniforms;

const vec3 kNormal(0, 0, 1);

Bsdf lambertian(const vec3& albedo = vec3(1)) {
    Bsdf m{};
    m.kind = kMaterialLambertian;
    m.albedo = albedo;
    return m;
}
Bsdf metal(float fuzz, const vec3& albedo = vec3(1)) {
    Bsdf m{};
    m.kind = kMaterialMetal;
    m.albedo = albedo;
    m.parameter[kMetalFuzz] = fuzz;
    return m;
}
Bsdf glass(float ior, const vec3& albedo = vec3(1)) {
    Bsdf m{};
    m.kind = kMaterialDielectric;
    m.albedo = albedo;
    m.parameter[kDielectricIor] = ior;
    return m;
}

dvec3 inPlane(double cosine, double phi = 0.3) {
    const double sine = std::sqrt((1 - cosine) * (1 + cosine));
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

// ---- lambertian ----------------------------------------------------------------------------------------------------

TEST(Lambertian, SampleAndEvaluationAgree) {
    Uniforms uniform(1);
    const vec3 albedo(0.2f, 0.5f, 0.9f);
    const vec3 n = normalize(vec3(0.3f, -0.8f, -0.4f));
    for (int i = 0; i < 1000; ++i) {
        const BsdfSample s = sampleBsdf(kFeatureAll, lambertian(albedo), n, 1, n, uniform.pair(), 0);
        const vec4 f = evalBsdf(kFeatureAll, lambertian(albedo), n, n, s.wi);
        EXPECT_EQ(s.weight, albedo);
        EXPECT_NEAR(f.w, s.pdf, 1e-6f);
        EXPECT_NEAR(f.y / f.w, 0.5f, 1e-6f);
        EXPECT_EQ(s.delta | s.transmitted, 0u);
    }
    EXPECT_EQ(evalBsdf(kFeatureAll, lambertian(albedo), n, n, -n), vec4(0));
    EXPECT_FALSE(isDelta(kFeatureAll, lambertian()));
}

// ---- metal ---------------------------------------------------------------------------------------------------------

// Probability that normalize(r + fuzz s), s uniform on the sphere, is within the angle gamma of r. The cone of that
// angle meets the sphere about the tip of r in two circles: beyond the far one and before the near one lie two caps.
double fuzzCdf(double fuzz, double gamma) {
    const double beta = std::asin(std::min(std::sin(gamma) / fuzz, 1.0)); // between the ray and the sphere's radius
    const double far = gamma + beta,
                 near = gamma + std::numbers::pi - beta; // polar angles of the circles, seen from the tip
    return (1 - std::cos(far)) / 2 + (1 + std::cos(near)) / 2;
}

class MetalFuzz : public testing::TestWithParam<double> {};

TEST_P(MetalFuzz, LobeHasTheExactDistribution) {
    const double fuzz = static_cast<float>(GetParam());
    Uniforms uniform(2);
    const vec3 wo(inPlane(1));
    const int rings = 32, sectors = 16;
    const double widest = std::asin(fuzz);
    std::vector<std::uint64_t> counts(rings * sectors);
    std::vector<double> weights(rings * sectors);
    const auto edge = [&](int k) { return std::asin(std::sin(widest) * std::sqrt(double(k) / rings)); };
    for (int k = 0; k < rings; ++k)
        for (int j = 0; j < sectors; ++j)
            weights[k * sectors + j] = fuzzCdf(fuzz, edge(k + 1)) - fuzzCdf(fuzz, edge(k));
    for (int i = 0; i < 1 << 19; ++i) {
        const BsdfSample s = sampleBsdf(kFeatureAll, metal(float(fuzz)), kNormal, 1, wo, uniform.pair(), 0);
        const double r2 = (double(s.wi.x) * s.wi.x + double(s.wi.y) * s.wi.y) / (fuzz * fuzz);
        const int sector =
            static_cast<int>((std::atan2(s.wi.y, s.wi.x) / (2 * std::numbers::pi) + 1) * sectors) % sectors;
        ++counts[std::clamp(static_cast<int>(r2 * rings), 0, rings - 1) * sectors + sector];
    }
    EXPECT_GT(chiSquareP(counts, weights), kSignificance);
}

// The density, integrated over rings by the substitution that removes the singularity at the rim, is that distribution.
TEST_P(MetalFuzz, DensityIntegratesToOne) {
    const double fuzz = static_cast<float>(GetParam());
    const dvec3 r = glm::normalize(dvec3(vec3(0.3f, -0.5f, 0.7f)));
    const Frame frame = makeFrame(vec3(r));
    const int steps = 20000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) / steps * std::numbers::pi / 2; // sin gamma = fuzz sin t
        const double gamma = std::asin(fuzz * std::sin(t));
        const double slope = fuzz * std::cos(t) / std::cos(gamma);
        const vec3 w = toWorld(frame, vec3(inPlane(std::cos(gamma), i * 0.7)));
        sum += double(fuzzPdf(vec3(r), float(fuzz), normalize(w))) * 2 * std::numbers::pi * std::sin(gamma) * slope *
               (std::numbers::pi / 2 / steps);
    }
    EXPECT_NEAR(sum, 1, fuzz < 0.01 ? 0.02 : 3e-3);
}

// White furnace: what a metal of albedo 1 loses is exactly the part of the lobe below the horizon.
TEST_P(MetalFuzz, LosesExactlyWhatPointsIntoTheSurface) {
    const double fuzz = static_cast<float>(GetParam());
    for (const double cosine : {1.0, 0.7, 0.3, 0.05}) {
        Uniforms uniform(3);
        Mean reflected;
        for (int i = 0; i < 1 << 16; ++i) {
            const BsdfSample s =
                sampleBsdf(kFeatureAll, metal(float(fuzz)), kNormal, 1, vec3(inPlane(cosine)), uniform.pair(), 0);
            reflected.add(s.weight.x);
            ASSERT_TRUE(s.weight.x == 0 || s.wi.z > 0);
        }
        EXPECT_TRUE(agrees(reflected, 1 - std::max(0.0, (1 - cosine / fuzz) / 2), 1e-4)) << cosine;
    }
}

TEST_P(MetalFuzz, SampleAndEvaluationAgree) {
    Uniforms uniform(4);
    const float fuzz = float(GetParam());
    const vec3 albedo(0.9f, 0.5f, 0.1f);
    const vec3 wo = normalize(vec3(0.5f, 0.2f, 0.6f));
    for (int i = 0; i < 4096; ++i) {
        const BsdfSample s = sampleBsdf(kFeatureAll, metal(fuzz, albedo), kNormal, 1, wo, uniform.pair(), 0);
        const vec4 f = evalBsdf(kFeatureAll, metal(fuzz, albedo), kNormal, wo, s.wi);
        ASSERT_EQ(s.delta, 0u);
        ASSERT_GT(s.pdf, 0.0f);
        ASSERT_EQ(f.w, s.pdf);
        if (s.weight.x > 0) {
            ASSERT_NEAR(f.y, 0.5f * f.w, 1e-6f * f.w);
        }
    }
    EXPECT_FALSE(isDelta(kFeatureAll, metal(fuzz)));
}

INSTANTIATE_TEST_SUITE_P(Fuzz, MetalFuzz, testing::Values(0.002, 0.01, 0.1, 0.5, 0.9, 1.0),
                         [](const auto& info) { return "Case" + std::to_string(info.index); });

TEST(Metal, FuzzOneIsACosineLobe) {
    const vec3 r = kNormal;
    for (const double cosine : {0.9, 0.5, 0.1})
        EXPECT_NEAR(fuzzPdf(r, 1, vec3(inPlane(cosine))), cosine / std::numbers::pi, 1e-6);
    EXPECT_EQ(fuzzPdf(r, 0.5f, -r), 0.0f);
}

TEST(Metal, WithoutFuzzIsAMirror) {
    Uniforms uniform(5);
    for (int i = 0; i < 1000; ++i) {
        const vec3 n = sampleSphere(uniform.pair());
        vec3 wo = sampleSphere(uniform.pair());
        if (dot(wo, n) < 0) wo = -wo;
        const BsdfSample s = sampleBsdf(kFeatureAll, metal(0, vec3(0.5f)), n, 1, wo, uniform.pair(), 0);
        EXPECT_EQ(s.delta, 1u);
        EXPECT_EQ(s.pdf, 0.0f);
        EXPECT_LE(length(s.wi + wo - n * (2 * dot(n, wo))), 1e-6f);
        EXPECT_EQ(evalBsdf(kFeatureAll, metal(0, vec3(0.5f)), n, wo, s.wi), vec4(0));
    }
    EXPECT_TRUE(isDelta(kFeatureAll, metal(0)));
    EXPECT_TRUE(isDelta(kFeatureAll & ~kFeatureFuzz, metal(0)));
}

// A direction keeps its length over a long chain of reflections.
TEST(Metal, MirrorsDoNotDrift) {
    Uniforms uniform(6);
    vec3 w = kNormal;
    for (int i = 0; i < 1000; ++i) w = mirrorDirection(w, sampleSphere(uniform.pair()));
    EXPECT_NEAR(length(w), 1.0f, 3e-7f);
}

// ---- dielectric ----------------------------------------------------------------------------------------------------

// Unpolarised reflectance and the refracted cosine in long double; eta = index here over index there.
std::pair<double, double> exactFresnel(double cosine, double eta) {
    const long double c = cosine, e = eta, k = 1 - e * e * (1 - c) * (1 + c);
    if (k <= 0) return {1, 0};
    const long double t = std::sqrt(k), s = (e * c - t) / (e * c + t), p = (c - e * t) / (c + e * t);
    return {double((s * s + p * p) / 2), double(t)};
}

TEST(Dielectric, FresnelIsExact) {
    Uniforms uniform(7);
    for (const float ior : {1.0001f, 1.33f, 1.5f, 2.4f}) {
        for (const float eta : {1 / ior, ior}) {
            for (int i = 0; i < 1 << 17; ++i) {
                float c = uniform();
                // A tenth next to the critical angle.
                if (eta > 1 && i % 10 == 0)
                    c = float(std::sqrt(1 - 1 / (double(eta) * eta)) * (1 + uniform.between(-1e-6, 1e-6)));
                const auto [reflectance, cosine] = exactFresnel(c, eta);
                const vec2 f = fresnel(c, eta);
                const double margin = std::abs(double(eta) * eta * (1 - double(c)) * (1 + double(c)) - 1);
                if ((f.y == 0) != (cosine == 0)) {
                    ASSERT_LE(margin, 4 * double(kEpsilon) * std::max(1.0, double(eta) * eta)) << c << ' ' << eta;
                    continue;
                }
                ASSERT_TRUE(f.x >= 0 && f.x <= 1);
                // Infinite slope at the critical angle, and at grazing incidence for an index near 1.
                const double slope = 1 / std::max(std::min(cosine, double(c)), 1e-3);
                ASSERT_NEAR(f.x, reflectance, 1e-6 * slope) << c << ' ' << eta;
            }
        }
    }
    for (const float c : {1.0f, 0.5f, 1e-3f, 1e-6f}) EXPECT_LE(fresnel(c, 1.0f).x, 1e-6f);
    EXPECT_FLOAT_EQ(fresnel(1, 1.5f).x, 0.04f);
    EXPECT_EQ(fresnel(0, 1 / 1.5f).x, 1.0f);
}

// Light that goes the other way along the same path is reflected alike.
TEST(Dielectric, FresnelIsReciprocal) {
    Uniforms uniform(8);
    for (int i = 0; i < 10000; ++i) {
        const float c = 0.05f + 0.95f * uniform();
        const vec2 f = fresnel(c, 1 / 1.5f);
        EXPECT_NEAR(fresnel(f.y, 1.5f).x, f.x, 1e-5);
    }
}

TEST(Dielectric, SnellAndTheWayBack) {
    Uniforms uniform(9);
    double worstSnell = 0, worstBack = 0;
    for (int i = 0; i < 1 << 17; ++i) {
        const float ior = i & 1 ? 1.5f : 2.4f;
        const uint front = i & 2 ? 1u : 0u;
        const double eta = front ? 1 / double(ior) : double(ior);
        const vec3 n = sampleSphere(uniform.pair());
        const Frame frame = makeFrame(n);
        double c = uniform();
        if (front == 0 && i % 10 == 0) c = std::sqrt(1 - 1 / (eta * eta)) * (1 + uniform.between(0, 1e-6));
        const vec3 wo = normalize(toWorld(frame, vec3(inPlane(std::max(c, 1e-3)))));
        const BsdfSample s = sampleBsdf(kFeatureAll, glass(ior), n, front, wo, vec2(0), 0.999999f);
        if (s.transmitted == 0) continue;
        ASSERT_LT(dot(s.wi, n), 0.0f);
        const double sineHere = glm::length(glm::cross(dvec3(wo), dvec3(n))),
                     sineThere = glm::length(glm::cross(dvec3(s.wi), dvec3(n)));
        worstSnell = std::max(worstSnell, std::abs(eta * sineHere - sineThere));
        // From the other side, where the other face is the front.
        const BsdfSample back = sampleBsdf(kFeatureAll, glass(ior), -n, 1u - front, s.wi, vec2(0), 0.999999f);
        if (back.transmitted == 0) continue;
        const double steep =
            std::max(std::abs(double(dot(s.wi, n))), 1e-3) * std::max(std::abs(double(dot(wo, n))), 1e-3);
        worstBack = std::max(worstBack, glm::length(dvec3(back.wi) - dvec3(wo)) * steep);
    }
    EXPECT_LE(worstSnell, 2e-6);
    EXPECT_LE(worstBack, 2e-6);
}

TEST(Dielectric, ChoosesByTheReflectance) {
    Uniforms uniform(10);
    const vec3 tint(0.9f, 0.8f, 0.7f);
    for (const uint front : {0u, 1u}) {
        for (const double cosine : {0.99, 0.8, 0.4, 0.1}) {
            const vec3 wo(inPlane(cosine));
            Mean reflected;
            for (int i = 0; i < 1 << 15; ++i) {
                const BsdfSample s = sampleBsdf(kFeatureAll, glass(1.5f, tint), kNormal, front, wo, vec2(0), uniform());
                reflected.add(1 - double(s.transmitted));
                ASSERT_EQ(s.delta, 1u);
                ASSERT_EQ(s.weight, tint);
                ASSERT_NEAR(length(s.wi), 1.0f, 3e-7f);
                ASSERT_EQ(s.transmitted != 0, s.wi.z < 0);
            }
            EXPECT_TRUE(agrees(reflected, exactFresnel(cosine, front ? 1 / 1.5 : 1.5).first)) << front << ' ' << cosine;
        }
    }
    EXPECT_TRUE(isDelta(kFeatureAll, glass(1.5f)));
    EXPECT_EQ(evalBsdf(kFeatureAll, glass(1.5f, tint), kNormal, kNormal, kNormal), vec4(0));
}

// A plane-parallel slab leaves a direction as it is.
TEST(Dielectric, SlabIsParallel) {
    Uniforms uniform(11);
    for (int i = 0; i < 10000; ++i) {
        const vec3 d = -vec3(inPlane(0.02 + 0.98 * double(uniform()), double(uniform()) * 6));
        const BsdfSample in = sampleBsdf(kFeatureAll, glass(1.5f), kNormal, 1, -d, vec2(0), 0.999999f);
        if (in.transmitted == 0) continue;
        const BsdfSample out = sampleBsdf(kFeatureAll, glass(1.5f), kNormal, 0, -in.wi, vec2(0), 0.999999f);
        if (out.transmitted == 0) continue;
        ASSERT_LE(length(out.wi - d) * std::abs(d.z), 2e-6f);
    }
}

// ---- others --------------------------------------------------------------------------------------------------------

TEST(Bsdf, WhatDoesNotScatterAbsorbs) {
    Bsdf emitter{};
    emitter.kind = kMaterialEmitter;
    const BsdfSample s = sampleBsdf(kFeatureAll, emitter, kNormal, 1, kNormal, vec2(0.5f), 0.5f);
    EXPECT_EQ(s.weight, vec3(0));
    EXPECT_EQ(evalBsdf(kFeatureAll, emitter, kNormal, kNormal, kNormal), vec4(0));
    EXPECT_FALSE(isDelta(kFeatureAll, emitter));
}

// A feature mask that is exactly what a material needs gives the same bits as the largest.
TEST(Bsdf, SupersetOfFeaturesChangesNothing) {
    Uniforms uniform(12);
    const std::pair<Bsdf, Features> materials[] = {{lambertian(), kFeatureLambertian},
                                                   {metal(0), kFeatureMetal},
                                                   {metal(0.3f), kFeatureMetal | kFeatureFuzz},
                                                   {glass(1.5f), kFeatureDielectric}};
    for (const auto& [material, features] : materials) {
        for (int i = 0; i < 100; ++i) {
            const vec2 u = uniform.pair();
            const vec3 wo(inPlane(0.1 + 0.9 * double(uniform())));
            const BsdfSample a = sampleBsdf(features, material, kNormal, 1, wo, u, u.x);
            const BsdfSample b = sampleBsdf(kFeatureAll, material, kNormal, 1, wo, u, u.x);
            ASSERT_EQ(a.wi, b.wi);
            ASSERT_EQ(a.pdf, b.pdf);
            ASSERT_EQ(evalBsdf(features, material, kNormal, wo, a.wi),
                      evalBsdf(kFeatureAll, material, kNormal, wo, a.wi));
        }
    }
}

TEST(Phase, IsotropicIsUniform) {
    Uniforms uniform(13);
    Mean z2;
    for (int i = 0; i < 1 << 14; ++i) {
        const BsdfSample s = samplePhase(vec3(0.3f), uniform.pair());
        z2.add(double(s.wi.z) * s.wi.z);
        ASSERT_EQ(s.pdf, kPhasePdf);
        ASSERT_EQ(s.weight, vec3(0.3f));
    }
    EXPECT_TRUE(agrees(z2, 1.0 / 3));
    EXPECT_NEAR(kPhasePdf, 1 / (4 * std::numbers::pi), 1e-8);
}

} // namespace
} // namespace rt::shared
