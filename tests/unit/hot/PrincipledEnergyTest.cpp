// Principled surfaces and energy: none is made, whatever is layered; and glass whose index is that around it.
#include <algorithm>
#include <cmath>
#include <cstdint>
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
using test::evalBothSides;
using test::outgoingAt;
using test::PrincipledCase;
using test::principledOf;
using test::Uniforms;

// Alone and one upon the other.
constexpr PrincipledCase kPrincipledLayers[] = {{"metal", 1},
                                                {"dielectric"},
                                                {"glass", 0, 1},
                                                {"sheet", 0, 1, 0, 0, true},
                                                {"clearcoat", 0, 0, 1},
                                                {"coated metal", 1, 0, 1},
                                                {"sheen", 0, 0, 0, 1},
                                                {"sheen on metal", 1, 0, 0, 1},
                                                {"sheen on glass", 0, 1, 0, 1},
                                                {"coated sheen", 0, 0, 1, 1},
                                                {"mixture", 0.3f, 0.5f, 0.5f, 0.5f},
                                                {"all", 0.5f, 0.5f, 1, 1}};

// Evenly spread points, of which the last digits are, too (Roberts, "The Unreasonable Effectiveness of Quasirandom
// Sequences", 2018).
constexpr int kPrincipledPoints = 1 << 12;
vec2 principledPoint(int i) {
    const double x = (i + 0.5) * 0.75487766624669276, y = (i + 0.5) * 0.56984029099805327;
    return vec2(std::min(float(x - std::floor(x)), 0x1.fffffep-1f), std::min(float(y - std::floor(y)), 0x1.fffffep-1f));
}

// A quadrature over the normals that wo sees, in doubles: of f(h, wo.h) times what h weighs.
template <typename Function>
double overVisibleNormals(const vec3& wo, float alpha, const Function& f) {
    constexpr int kHeights = 200, kTurns = 96; // of half a turn, as both halves are alike
    double sum = 0;
    for (int i = 0; i < kHeights; ++i)
        for (int k = 0; k < kTurns; ++k) {
            const double t = (i + 0.5) / kHeights; // denser at both ends, where square roots vary
            const vec2 u(float(t * t * (3 - 2 * t)), float((k + 0.5) / (2 * kTurns)));
            const vec3 h = sampleVisibleNormal(wo, alpha, u);
            sum += 6 * t * (1 - t) * f(h, std::min(double(dot(wo, h)), 1.0));
        }
    return sum / (kHeights * kTurns);
}

// Smith's height-correlated masking of both directions over that of wo; 0 below the surface.
double passing(double cosO, double cosI, double alpha) {
    if (!(cosI > 0)) return 0;
    const auto lambda = [alpha](double c) { return 0.5 * (std::sqrt(1 + alpha * alpha * (1 / (c * c) - 1)) - 1); };
    return (1 + lambda(cosO)) / (1 + lambda(cosO) + lambda(cosI));
}

// What facets reflect of which normal and grazing reflectance are these.
double reflectedByFacets(double f0, double f90, float alpha, const vec3& wo) {
    const auto reflectance = [&](double c) { return f0 + (f90 - f0) * std::pow(1 - c, 5); };
    if (isMirror(alpha)) return reflectance(double(wo.z));
    return overVisibleNormals(wo, alpha, [&](const vec3& h, double c) {
        return reflectance(c) * passing(double(wo.z), 2 * c * double(h.z) - double(wo.z), double(alpha));
    });
}

// Of one colour channel; a film changes what is reflected.
double sentOutByGlass(const PrincipledLobes& lobes, const vec3& wo, int channel) {
    const bool filmed = hasLobe(lobes.others, kLobeFilm);
    const double scale = filmed ? double(lobes.rare.filmScale[channel]) : 1;
    const double offset = filmed ? double(lobes.rare.filmOffset[channel]) : 0;
    if (isMirror(lobes.alpha) || isStraight(lobes)) return double(lobes.glass);
    if (lobes.thin != 0u) return double(lobes.glass) * reflectedByFacets(1, 1, lobes.alpha, wo);
    return double(lobes.glass) * overVisibleNormals(wo, lobes.alpha, [&](const vec3& h, double c) {
               const double cosO = double(wo.z), eta = double(lobes.eta), alpha = double(lobes.alpha);
               const double squared = 1 - eta * eta * (1 - c * c);
               const double t = std::sqrt(std::max(squared, 0.0));
               const double s = (eta * c - t) / (eta * c + t), p = (c - eta * t) / (c + eta * t);
               const double bare = squared > 0 ? 0.5 * (s * s + p * p) : 1;
               const double reflected = bare < 1 ? scale * bare + offset : 1;
               return reflected * passing(cosO, 2 * c * double(h.z) - cosO, alpha) +
                      (1 - reflected) * passing(cosO, eta * cosO - (eta * c - t) * double(h.z), alpha);
           });
}

double sentOutBySheen(const PrincipledLobes& lobes, const vec3& wo) {
    if (!(lobes.sheen.x > 0)) return 0;
    constexpr int kHeights = 200, kTurns = 100;
    double sum = 0;
    for (int i = 0; i < kHeights; ++i)
        for (int k = 0; k < kTurns; ++k) {
            const double t = (i + 0.5) / kHeights, z = t * t, r = std::sqrt((1 - z) * (1 + z));
            const double turn = test::kPi * (k + 0.5) / kTurns;
            const vec3 wi(float(r * std::cos(turn)), float(r * std::sin(turn)), float(z));
            sum += double(sheenValue(lobes.sheenExponent, wo, wi, normalize(wo + wi))) * z * t;
        }
    return double(lobes.sheen.x) * sum * 4 * test::kPi / (kHeights * kTurns);
}

// Of light that arrives from everywhere alike, by all lobes; wo has no y.
double principledSentOut(const PrincipledLobes& lobes, const vec3& wo, int channel = 0) {
    double sum = double(lobes.diffuse[channel]) + sentOutBySheen(lobes, wo) +
                 reflectedByFacets(double(lobes.f0[channel]), double(lobes.f90[channel]), lobes.alpha, wo);
    if (lobes.coat > 0) sum += double(lobes.coat) * reflectedByFacets(double(kCoatReflectance), 1, lobes.coatAlpha, wo);
    if (lobes.glass > 0) sum += sentOutByGlass(lobes, wo, channel);
    return sum;
}

vec3 withoutY(double cosine) {
    return vec3(float(std::sqrt((1 - cosine) * (1 + cosine))), 0, float(cosine));
}

// Surfaces do not send out more than arrives, whatever is layered upon what, however rough each layer is and however
// low the light.
TEST(Principled, NothingMakesEnergy) {
    const float roughnesses[] = {0.0f, 0.04f, 0.1f, 0.25f, 0.6f, 1.0f};
    const double cosines[] = {1e-3, 0.012, 0.05, 0.3, 0.62, 1};
    for (const PrincipledCase& which : kPrincipledLayers)
        for (const float roughness : roughnesses)
            for (const float above : {0.0f, 0.15f, 0.5f}) {
                if (above > 0 && which.clearcoat == 0 && which.sheen == 0) continue;
                Principled p = principledOf(which, roughness);
                p.clearcoatRoughness.factor = p.sheenRoughness.factor = above;
                for (const double cosine : cosines) {
                    const vec3 wo = withoutY(cosine);
                    for (const bool front : {true, false}) {
                        if (!front && !(which.transmission > 0)) continue;
                        EXPECT_LE(principledSentOut(bsdfOf(p, vec3(1), wo, front).lobes, wo), 1.001)
                            << which.name << ' ' << roughness << ' ' << above << ' ' << cosine << ' ' << front;
                    }
                }
            }
}

// What is transmitted diffusely and what is reflected add up to what arrives, but for what tables leave.
TEST(Principled, TranslucentSurfacesShareOutWhatTheyScatter) {
    for (const PrincipledCase& which : test::kTranslucentCases)
        for (const float roughness : {0.0f, 0.1f, 0.5f, 1.0f})
            for (const double cosine : {1e-3, 0.05, 0.3, 1.0})
                for (const bool front : {true, false}) {
                    Principled p = principledOf(which, roughness);
                    p.anisotropy.factor = 0; // of which no quadrature here knows
                    const vec3 wo = withoutY(cosine);
                    const PrincipledLobes here = bsdfOf(p, vec3(1), wo, front).lobes;
                    const PrincipledLobes beyond = bsdfOf(p, vec3(1), wo, front, test::kUp, true).lobes;
                    EXPECT_EQ(beyond.diffuseShare, 1);
                    const double sum = principledSentOut(here, wo) + double(beyond.diffuse.x);
                    EXPECT_LE(sum, 1.001) << which.name << ' ' << roughness << ' ' << cosine;
                    EXPECT_GT(sum, 0.9) << which.name << ' ' << roughness << ' ' << cosine;
                    EXPECT_NEAR(beyond.diffuse.x, (here.diffuse.x + beyond.diffuse.x) * which.beyond, 1e-6);
                }
}

// Films of any thickness send out no more than arrives in any channel, and smooth glass all of it.
TEST(Principled, FilmsMakeNoEnergy) {
    const PrincipledCase cases[] = {{"metal", 1, 0, 0, 0, false, 0, 1},
                                    {"dielectric", 0, 0, 0, 0, false, 0, 1},
                                    {"glass", 0, 1, 0, 0, false, 0, 1},
                                    {"bubble", 0, 1, 0, 0, true, 0, 1},
                                    {"mixture", 0.4f, 0.5f, 0.5f, 0.3f, false, 0, 0.6f}};
    for (const PrincipledCase& which : cases)
        for (const float roughness : {0.0f, 0.1f, 0.4f, 1.0f})
            for (const float thickness : {60.0f, 150.0f, 330.0f, 900.0f})
                for (const float ior : {1.2f, 1.8f})
                    for (const double cosine : {1e-3, 0.05, 0.3, 0.7, 1.0})
                        for (const bool front : {true, false}) {
                            if (!front && !(which.transmission > 0)) continue;
                            Principled p = principledOf(which, roughness);
                            p.filmThickness = vec2(thickness);
                            p.filmIor = ior;
                            const vec3 wo = withoutY(cosine);
                            const PrincipledLobes lobes = bsdfOf(p, vec3(1), wo, front).lobes;
                            for (int c = 0; c < 3; ++c) {
                                const double sent = principledSentOut(lobes, wo, c);
                                EXPECT_LE(sent, 1.001) << which.name << ' ' << roughness << ' ' << thickness << ' '
                                                       << ior << ' ' << cosine << ' ' << front << ' ' << c;
                                if (roughness == 0 && which.transmission == 1) {
                                    EXPECT_GT(sent, 0.99) << which.name << ' ' << thickness << ' ' << cosine;
                                }
                            }
                        }
}

// At grazing angles smooth fibres would send out several times what arrives, were they not bounded.
TEST(Principled, SheenIsBoundedByWhatArrives) {
    for (const float roughness : {0.0f, 0.1f, 0.15f, 0.2f, 0.3f})
        for (const double cosine : {1e-3, 0.01, 0.05}) {
            const vec3 wo = withoutY(cosine);
            Principled p = principledOf({"sheen", 0, 0, 0, 1}, 1);
            p.sheenRoughness.factor = roughness;
            p.specular.factor = 0;
            const double alone = sentOutBySheen(bsdfOf(p, vec3(0), wo).lobes, wo);
            EXPECT_LE(alone, 1.001) << roughness << ' ' << cosine;
            EXPECT_GT(alone, 0.985) << roughness << ' ' << cosine;
        }
}

// ---- glass that hardly bends light ---------------------------------------------------------------------------------

// Where the indices are equal there is no surface to be seen, however rough: as a limit, too, in floats.
TEST(Principled, GlassOfEqualIndicesIsNotThere) {
    for (const float ior : {1.0f, 1.0000001f, 1.00001f, 1.0001f, 1.001f})
        for (const float roughness : {0.0f, 0.02f, 0.04f, 0.3f, 1.0f})
            for (const double cosine : {0.2, 0.5, 0.9, 1.0})
                for (const bool front : {true, false}) {
                    Principled p = principledOf({"glass", 0, 1}, roughness);
                    p.ior = ior;
                    const vec3 wo = outgoingAt(cosine);
                    const Bsdf b = bsdfOf(p, vec3(1), wo, front);
                    double through = 0, all = 0;
                    for (int i = 0; i < kPrincipledPoints; ++i) {
                        const BsdfSample s = drawFrom(b, wo, principledPoint(i));
                        ASSERT_TRUE(isFinite(s.weight) && isFinite(s.wi));
                        all += double(s.weight.x) / kPrincipledPoints;
                        // Facets bend by little more than the difference of the indices.
                        const bool isThrough = length(s.wi + wo) < 2e-6f + 40 * (ior - 1);
                        if (isThrough) through += double(s.weight.x) / kPrincipledPoints;
                    }
                    EXPECT_NEAR(all, 1, ior == 1 ? 1e-5 : 0.006) << ior << ' ' << roughness << ' ' << cosine;
                    EXPECT_GT(through, ior == 1 ? 0.99999 : 0.98) << ior << ' ' << roughness << ' ' << cosine;
                }
}

// On both sides of where directions are given up: what is reflected has its density, and is the same.
TEST(Principled, WeakGlassReflectsAsItsLimit) {
    for (const float roughness : {0.3f, 1.0f})
        for (const bool front : {true, false}) {
            const vec3 wo = outgoingAt(0.1);
            Principled p = principledOf({"glass", 0, 1}, roughness);
            p.ior = 1 + 0.99f * kMinBend;
            const Bsdf below = bsdfOf(p, vec3(1), wo, front);
            p.ior = 1 + 1.05f * kMinBend;
            const Bsdf beyond = bsdfOf(p, vec3(1), wo, front);
            ASSERT_TRUE(isStraight(below.lobes));
            ASSERT_FALSE(isStraight(beyond.lobes));
            const auto reflected = [&](const Bsdf& b) {
                double sum = 0;
                for (int i = 0; i < kPrincipledPoints; ++i) {
                    const BsdfSample s = drawFrom(b, wo, principledPoint(i));
                    if (s.transmitted == 0u) sum += double(s.weight.x) / kPrincipledPoints;
                    if (s.transmitted != 0u || !(s.pdf > 0)) continue;
                    const vec4 f = evalBothSides(b, wo, s.wi);
                    EXPECT_NEAR(f.w, s.pdf, 2e-3f * s.pdf);
                    EXPECT_NEAR(s.weight.x * s.pdf, f.x, 2e-3f * f.x);
                }
                return sum;
            };
            EXPECT_NEAR(reflected(below), reflected(beyond), 0.002) << roughness << ' ' << front;
        }
}

// Where glass does bend light, a little, directions come as their density says.
TEST(Principled, GlassOfLowIndexIsSampledAsItsDensitySays) {
    Uniforms uniform(38);
    for (const float ior : {1.1f, 1.25f})
        for (const bool front : {true, false}) {
            Principled p = principledOf({"glass", 0, 1}, 1);
            p.ior = ior;
            const vec3 wo = outgoingAt(0.6);
            const Bsdf b = bsdfOf(p, vec3(1), wo, front);
            const auto density = [&](double u, double v) {
                return double(evalBothSides(b, wo, vec3(test::onSphere(u, v))).w);
            };
            const std::vector<double> expected = test::cellMasses(density);
            std::vector<std::uint64_t> counts(expected.size());
            for (int i = 0; i < 1 << 14; ++i) {
                const BsdfSample s = drawFrom(b, wo, uniform.pair());
                if (s.pdf > 0) ++counts[test::cellOf(s.wi)];
            }
            EXPECT_GT(test::chiSquareP(counts, expected), test::kSignificance) << ior << ' ' << front;
        }
}

} // namespace
} // namespace rt::shared
