// Sampling of single lights: estimates and densities against exact irradiances and solid angles, what cannot
// contribute, stress.
#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <string>

#include <glm/matrix.hpp>

#include "tests/unit/LightDraws.h"
#include "tests/unit/LightShapes.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {
namespace {

using glm::dvec3;
using test::agrees;
using test::Mean;
using test::Uniforms;

// Not below the ellipsoid's shortest half axis by more than a factor of two.
double shortestAxis(const Light& ellipsoid) {
    const glm::dmat3 back = glm::inverse(axesOf(ellipsoid));
    return 1 / std::sqrt(glm::dot(back[0], back[0]) + glm::dot(back[1], back[1]) + glm::dot(back[2], back[2]));
}

double solidAngle(const Light& light) {
    if (light.kind == kLightEllipsoid) return test::ellipsoidSolidAngle(dvec3(light.position), axesOf(light));
    if (light.kind == kLightSphere) {
        const double s = light.radius / glm::length(dvec3(light.position));
        return 2 * std::numbers::pi * s * s / (1 + std::sqrt((1 - s) * (1 + s)));
    }
    const auto v = vertices(light);
    double sum = test::triangleSolidAngle(v[0], v[1], v[2]);
    if (v.size() == 4) sum += test::triangleSolidAngle(v[0], v[2], v[3]);
    return sum;
}

// The shading point is the origin, its normal +z.
struct Case {
    std::string name;
    Light light;
    bool areaIsHopeless = false; // unbounded weights: no standard error to test with
};

std::vector<Case> cases() {
    return {
        {"quad over the point", quad({-0.5, -0.3, 0.5}, {1, 0, 0}, {0, 0.6, 0})},
        {"quad 2 x 2 at 0.5", quad({-1, -1, 0.5}, {2, 0, 0}, {0, 2, 0})},
        {"quad off axis", quad({3, 1, 2}, {1, 0, 0}, {0, 0.5, 0.4})},
        {"quad on a wall", quad({0.05, -1, 0}, {0, 2, 0}, {0, 0, 2}), true},
        {"quad across the horizon", quad({1, -1, -1}, {0, 2, 0}, {0, 0, 2})},
        {"quad far", quad({30, 10, 60}, {1, 0, 0}, {0, 1, 0})},
        {"quad very far", quad({3e4, 1e4, 6e4}, {1, 0, 0}, {0, 1, 0})},
        {"strip", quad({-2, 0.5, 0.3}, {4, 0, 0}, {0, 0, 0.05}), true},
        {"strip along v", quad({-2, 0.5, 0.3}, {0, 0, 0.1}, {4, 1, 0})},
        {"strip end on", quad({0.3, -0.02, 0.05}, {3, 0, 0.1}, {0, 0.04, 0}), true},
        {"strip across the horizon", quad({0.4, -0.5, -1}, {0, 0.1, 0}, {0, 0, 3})},
        {"parallelogram", quad({-0.2, -0.3, 1}, {1, 0, 0}, {0.3, 0.6, 0.1})},
        {"parallelogram far", quad({-2, -3, 10}, {1, 0, 0}, {0.3, 0.6, 0.1})},
        {"triangle", triangle({-0.5, -0.3, 0.5}, {0.5, -0.3, 0.6}, {-0.2, 0.5, 0.5})},
        {"triangle across the horizon", triangle({1, -1, -1}, {1, 1, -1}, {1, 0, 2})},
        {"triangle far", triangle({5, -0.3, 50}, {6, -0.3, 50}, {5, 0.5, 50})},
        {"triangle sliver", triangle({-0.5, 0.2, 1}, {0.5, 0.2, 1}, {0.1, 0.201, 1})},
        {"triangle grazing", triangle({1, -0.5, 0.2}, {1, 0.5, 0.21}, {2, 0.1, 0.2})},
        {"sphere overhead", sphere({0, 0, 1}, 0.2)},
        {"sphere near", sphere({0.1, 0.3, 1}, 0.9), true},
        {"sphere far", sphere({0, 30, 100}, 1)},
        {"sphere very far", sphere({0, 3e4, 1e5}, 1)},
        {"sphere cut by the horizon",
         sphere({0, std::cos(std::numbers::pi / 18), std::sin(std::numbers::pi / 18)}, 0.5)},
        {"sphere below the horizon but for a cap",
         sphere({0, std::cos(std::numbers::pi / 18), -std::sin(std::numbers::pi / 18)}, 0.5)},
        {"ellipsoid overhead", ellipsoid({0, 0, 1}, {0.3, 0, 0, 0, 0.2, 0, 0, 0, 0.1})},
        {"ellipsoid of axes 1 10 0.1", ellipsoid({1, -2, 3}, {0.8, 0.6, 0, -6, 8, 0, 0, 0, 0.1})},
        {"ellipsoid edge-on", ellipsoid({2, 1, 0.5}, {0.8, 0.6, 0, -6, 8, 0, 0, 0, 0.1})},
        {"ellipsoid sheared and mirrored", ellipsoid({0.5, 1, 2}, {1, 0, 0, 0.8, 0.5, 0.1, -0.3, 0.2, -0.4})},
        {"ellipsoid across the horizon", ellipsoid({0.5, 2, -0.2}, {0.4, 0, 0.3, 0, 1, 0, -0.6, 0, 0.9})},
        {"ellipsoid near", ellipsoid({0.2, 0.1, 0.6}, {0.9, 0.1, 0, -0.1, 0.9, 0, 0, 0, 0.5}), true},
        {"ellipsoid far", ellipsoid({0, 3e3, 1e4}, {1, 0.5, 0, 0, 2, 0, 0, 0.3, 0.2})},
    };
}

const std::array kMethods{kShapeAuto, kShapeSolidAngle, kShapeProjected, kShapeArea};

class LightCase : public testing::TestWithParam<Case> {};

TEST_P(LightCase, IrradianceIsAnalyticForEveryMethod) {
    const auto& [name, light, areaIsHopeless] = GetParam();
    for (const uint method : kMethods) {
        if (method == kShapeArea && areaIsHopeless) continue;
        const Mean mean = irradianceEstimates(light, method, 1, 1 << 16);
        const double rounding = name == "triangle sliver" ? 3e-5 : 1e-5; // a thousandth as wide as it is long
        EXPECT_TRUE(agrees(mean, irradiance(light, dvec3(kLitUp)), rounding)) << name << ", method " << method;
    }
}

// Seen from a point in a medium nothing is clipped, and the mean of 1 / pdf is the solid angle.
TEST_P(LightCase, InverseDensitySumsToTheSolidAngle) {
    const auto& [name, light, areaIsHopeless] = GetParam();
    for (const uint method : kMethods) {
        if (method == kShapeArea && areaIsHopeless) continue;
        Uniforms uniform(2);
        Mean mean;
        for (int i = 0; i < 1 << 16; ++i) {
            const LightSample s =
                sampleLight(kFeatureAll, withMethod(method), light, vec3(0), vec3(0), 0, uniform.pair());
            mean.add(s.pdf > 0 ? 1 / double(s.pdf) : 0);
        }
        EXPECT_TRUE(agrees(mean, solidAngle(light))) << name << ", method " << method;
    }
}

TEST_P(LightCase, SampleIsOneGeometry) {
    const auto& [name, light, areaIsHopeless] = GetParam();
    for (const uint method : kMethods) {
        Uniforms uniform(3);
        double pdf = 0, point = 0, surface = 0, length = 0;
        for (int i = 0; i < 1 << 13; ++i) {
            const LightSample s =
                sampleLight(kFeatureAll, withMethod(method), light, vec3(0), vec3(0), 0, uniform.pair());
            if (!(s.pdf > 0)) continue;
            const float again =
                lightPdf(kFeatureAll, withMethod(method), light, vec3(0), vec3(0), 0, s.wi, s.distance, s.normal);
            pdf = std::max(pdf, std::abs(double(again) / double(s.pdf) - 1));
            point =
                std::max(point, glm::length(dvec3(s.point) - dvec3(s.wi) * double(s.distance)) / double(s.distance));
            length = std::max(length, std::abs(glm::length(dvec3(s.wi)) - 1));
            const dvec3 away = dvec3(s.point) - dvec3(light.position);
            const double off = light.kind == kLightSphere ? glm::length(away) - light.radius
                               : light.kind == kLightEllipsoid
                                   ? (glm::length(glm::inverse(axesOf(light)) * away) - 1) * shortestAxis(light)
                                   : glm::dot(away, dvec3(light.normal));
            const bool isRound = light.kind == kLightSphere || light.kind == kLightEllipsoid;
            surface =
                std::max(surface, std::abs(off) / (isRound ? glm::length(dvec3(light.position)) : double(s.distance)));
            if (!isRound) {
                const dvec3 placed = dvec3(light.edgeU) * double(s.uv.x) + dvec3(light.edgeV) * double(s.uv.y);
                surface = std::max(surface, glm::length(placed - away) / double(s.distance));
            }
        }
        // Area densities far out on a strip depend on the cosine, which a float direction resolves to 2^-24 / cosine.
        EXPECT_LE(pdf, 2e-5) << name << ", method " << method;
        EXPECT_LE(point, 2e-6) << name << ", method " << method;
        EXPECT_LE(surface, 2e-6) << name << ", method " << method;
        EXPECT_LE(length, 1e-6) << name << ", method " << method;
    }
}

// The density that multiple importance sampling asks for is that of the sample, from a surface too.
TEST_P(LightCase, DensityIsThatOfTheSampleOnASurface) {
    const auto& [name, light, areaIsHopeless] = GetParam();
    for (const uint method : kMethods) {
        Uniforms uniform(13);
        std::vector<double> differences;
        for (int i = 0; i < 1 << 13; ++i) {
            const LightSample s =
                sampleLight(kFeatureAll, withMethod(method), light, vec3(0), kLitUp, 0, uniform.pair());
            if (!(s.pdf > 0)) continue;
            const float again =
                lightPdf(kFeatureAll, withMethod(method), light, vec3(0), kLitUp, 0, s.wi, s.distance, s.normal);
            ASSERT_TRUE(isFinite(again) && again >= 0) << name;
            differences.push_back(std::abs(double(again) / double(s.pdf) - 1));
        }
        if (differences.empty()) continue;
        std::sort(differences.begin(), differences.end());
        EXPECT_LE(differences[differences.size() / 2], 1e-4) << name << ", method " << method;
        // At the very ends of a fit a direction does not tell the slice that it came from to all digits.
        EXPECT_LE(differences[differences.size() * 999 / 1000], 2e-2) << name << ", method " << method;
    }
}

// All lengths times 2^k: every direction and uv the same bits, densities too.
TEST_P(LightCase, ScalesExactly) {
    const auto& [name, light, areaIsHopeless] = GetParam();
    for (const uint method : kMethods) {
        for (const float scale : {0x1p-16f, 0x1p16f}) {
            const Light scaled = scaledLight(light, scale);
            Uniforms uniform(4);
            for (int i = 0; i < 256; ++i) {
                const vec2 u = uniform.pair();
                const LightSample a = sampleLight(kFeatureAll, withMethod(method), light, vec3(0), kLitUp, 0, u);
                const LightSample b = sampleLight(kFeatureAll, withMethod(method), scaled, vec3(0), kLitUp, 0, u);
                ASSERT_EQ(a.wi, b.wi) << name << ", method " << method;
                ASSERT_EQ(a.pdf, b.pdf) << name << ", method " << method;
                ASSERT_EQ(a.point * scale, b.point) << name << ", method " << method;
            }
        }
    }
}

TEST_P(LightCase, CornersOfTheUnitSquareAreFinite) {
    const auto& [name, light, areaIsHopeless] = GetParam();
    const float last = 0x0.ffffffp0f;
    for (const uint method : kMethods) {
        for (const vec2 u : {vec2(0, 0), vec2(last, 0), vec2(0, last), vec2(last, last), vec2(0.5f, 0.5f)}) {
            const LightSample s = sampleLight(kFeatureAll, withMethod(method), light, vec3(0), vec3(0), 0, u);
            EXPECT_TRUE(isFinite(s.wi) && isFinite(s.point) && isFinite(s.normal) && isFinite(s.pdf)) << name;
            EXPECT_GE(s.pdf, 0.0f) << name;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Lights, LightCase, testing::ValuesIn(cases()), [](const auto& info) {
    std::string name = info.param.name;
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return name;
});

// ---- what cannot contribute ----------------------------------------------------------------------------------------

TEST(Lights, DarkSideAndHorizon) {
    Uniforms uniform(5);
    Light front = quad({-0.5, -0.3, 0.5}, {1, 0, 0}, {0, 0.6, 0}); // faces +z, away from the point
    front.sides = kSidesFront;
    const Light below = quad({-0.5, -0.3, -0.5}, {1, 0, 0}, {0, 0.6, 0});
    Light facing = quad({-0.5, -0.3, 0.5}, {0, 0.6, 0}, {1, 0, 0});
    facing.sides = kSidesFront;
    for (const uint method : kMethods) {
        for (int i = 0; i < 100; ++i) {
            const vec2 u = uniform.pair();
            EXPECT_EQ(sampleLight(kFeatureAll, withMethod(method), front, vec3(0), kLitUp, 0, u).pdf, 0.0f);
            EXPECT_EQ(sampleLight(kFeatureAll, withMethod(method), below, vec3(0), kLitUp, 0, u).pdf, 0.0f);
            EXPECT_GT(sampleLight(kFeatureAll, withMethod(method), below, vec3(0), vec3(0), 0, u).pdf, 0.0f);
            EXPECT_GT(sampleLight(kFeatureAll, withMethod(method), facing, vec3(0), kLitUp, 0, u).pdf, 0.0f);
        }
    }
    // In the light's own plane.
    const LightSample edge = sampleLight(kFeatureAll, withMethod(kShapeArea), quad({1, 0, 0}, {1, 0, 0}, {0, 0, 1}),
                                         vec3(0), vec3(0), 0, vec2(0.3f, 0.6f));
    EXPECT_EQ(edge.pdf, 0.0f);
}

// Half of the quad is below the horizon, to which an edge is parallel: no number is lost on that half, and the density
// is that of the other half alone. Area sampling, which the others are compared with, takes all of it.
TEST(Lights, OfAQuadThePartAboveTheHorizonIsSampled) {
    const Light whole = quad({1, -1, -1}, {0.2, 2, 0}, {0, 0, 2}), above = quad({1, -1, 0}, {0.2, 2, 0}, {0, 0, 1});
    const vec3 normal(0, 0, 1);
    for (const uint method : {kShapeAuto, kShapeSolidAngle, kShapeArea}) {
        const RenderParams params = withMethod(method);
        int used = 0, all = 0;
        for (float u = 0.05f; u < 1; u += 0.1f)
            for (float v = 0.05f; v < 1; v += 0.1f, ++all) {
                const LightSample s = sampleLight(kFeatureQuadLights, params, whole, vec3(0), normal, 0, vec2(u, v));
                if (!(s.pdf > 0)) continue;
                ++used;
                EXPECT_GT(s.uv.y, 0.5f);
                EXPECT_LT(glm::length(s.point - (whole.position + whole.edgeU * s.uv.x + whole.edgeV * s.uv.y)), 1e-6f);
                if (method == kShapeSolidAngle) {
                    EXPECT_NEAR(s.pdf * solidAngle(above), 1, 1e-5);
                }
            }
        EXPECT_EQ(used, method == kShapeArea ? all / 2 : all);
    }
}

// On a diffuse surface: of a sphere wholly above the horizon nothing is left, of one that it cuts a tenth of what
// uniform solid angle leaves, of a near rectangle a fifth, whether it is cut or not; overhead, where the cosine is the
// same at all corners, not more.
TEST(Lights, AutomaticSamplingKnowsTheCosine) {
    const auto variance = [](const Light& light, uint method) {
        return irradianceEstimates(light, method, 21, 1 << 14).relativeVariance();
    };
    for (const Light& light : {sphere({0.3, -0.4, 1}, 0.9), sphere({2, 1, 0.6}, 0.5), sphere({0, 3, 2}, 0.2)}) {
        EXPECT_LT(variance(light, kShapeAuto), 1e-10);
        EXPECT_GT(variance(light, kShapeSolidAngle), 1e-3);
    }
    for (const Light& light : {sphere({2, 0, 0.2}, 0.9), sphere({1, 1, -0.1}, 0.5), sphere({0, 3, -0.4}, 0.6)})
        EXPECT_LT(10 * variance(light, kShapeAuto), variance(light, kShapeSolidAngle));
    for (const Light& light :
         {quad({0.5, -1, 0.2}, {0, 2, 0}, {0.3, 0, 1.5}), quad({1, -1, -0.6}, {0, 1.6, 0}, {0.2, 0, 2})})
        EXPECT_LT(4.5 * variance(light, kShapeAuto), variance(light, kShapeSolidAngle));
    const Light overhead = quad({-1, -1, 1}, {2, 0, 0}, {0, 2, 0});
    EXPECT_LT(variance(overhead, kShapeAuto), 1.01 * variance(overhead, kShapeSolidAngle));
}

// Where the way of sampling a rectangle changes, as a strip or by solid angle, equal numbers lead to much the same
// point: points that are stratified within a pixel stay so. Both ways round, and seen from either side of the middle.
TEST(Lights, EqualNumbersLeadToNeighboursWhereTheMethodChanges) {
    const auto rectangle = [](bool swapped, double shift, double distance) {
        const dvec3 along(2, 0, 0), across(0, 1.5, 0);
        return quad({shift - 1, -0.75, distance}, swapped ? across : along, swapped ? along : across);
    };
    Uniforms uniform(31);
    for (const bool swapped : {false, true}) {
        for (const double shift : {-1.5, -0.2, 0.2, 1.5}) {
            for (int i = 0; i < 32; ++i) {
                const vec2 numbers = uniform.pair();
                std::optional<vec2> before;
                for (double distance = 2; distance < 4; distance += 0.01) {
                    const vec2 uv = sampleLight(kFeatureAll, withMethod(kShapeAuto),
                                                rectangle(swapped, shift, distance), vec3(0), kLitUp, 0, numbers)
                                        .uv;
                    if (before) {
                        ASSERT_LT(glm::length(uv - *before), 0.05f) << swapped << ", " << shift << ", " << distance;
                    }
                    before = uv;
                }
            }
        }
    }
}

TEST(Lights, InsideASphere) {
    Light light = sphere({0.3, -0.2, 0.4}, 2);
    const RenderParams params = withMethod(kShapeAuto);
    Uniforms uniform(6);
    EXPECT_EQ(sampleLight(kFeatureAll, params, light, vec3(0), kLitUp, 0, uniform.pair()).pdf, 0.0f);
    light.sides = kSidesBoth;
    Mean surface, medium;
    for (int i = 0; i < 1 << 14; ++i) {
        const vec2 u = uniform.pair();
        const LightSample s = sampleLight(kFeatureAll, params, light, vec3(0), kLitUp, 0, u);
        ASSERT_GT(s.pdf, 0.0f);
        surface.add(double(s.wi.z) / double(s.pdf));
        EXPECT_NEAR(glm::length(dvec3(s.point) - dvec3(light.position)), 2, 2e-6);
        EXPECT_NEAR(lightPdf(kFeatureAll, params, light, vec3(0), kLitUp, 0, s.wi, s.distance, s.normal), s.pdf, 1e-6f);
        const LightSample m = sampleLight(kFeatureAll, params, light, vec3(0), vec3(0), 0, u);
        medium.add(1 / double(m.pdf));
        EXPECT_EQ(lightPdf(kFeatureAll, params, light, vec3(0), vec3(0), 0, m.wi, m.distance, m.normal), m.pdf);
    }
    EXPECT_TRUE(agrees(surface, std::numbers::pi));
    EXPECT_TRUE(agrees(medium, 4 * std::numbers::pi));
}

// Rounding may take a point near a huge sphere to be inside of it, while a ray meets the near side: no sample lies
// there, so that the ray's light counts in full.
TEST(Lights, SideOfASphereThatIsNotSampledHasNoDensity) {
    const vec3 up(0, 1, 0);
    for (const uint method : {kShapeAuto, kShapeSolidAngle, kShapeArea}) {
        const RenderParams params = withMethod(method);
        const auto pdf = [&](double center, const vec3& lightNormal) {
            const Light light = sphere({0, center, 0}, 1);
            return lightPdf(kFeatureSphereLights, params, light, vec3(0), up, 0, up, 1, lightNormal);
        };
        EXPECT_EQ(pdf(0.5, -up), 0);
        EXPECT_GT(pdf(0.5, up), 0);
        EXPECT_EQ(pdf(2, up), 0);
        EXPECT_GT(pdf(2, -up), 0);
    }
}

TEST(Lights, MovingSphereIsWhereItIsAtTheRaysTime) {
    Light light = sphere({-1, 0, 2}, 0.3);
    light.edgeU = vec3(2, 0, 0);
    const vec2 u(0.3f, 0.7f);
    const LightSample moved = sampleLight(kFeatureAll, withMethod(kShapeAuto), light, vec3(0), kLitUp, 0.5f, u);
    const LightSample still =
        sampleLight(kFeatureAll, withMethod(kShapeAuto), sphere({0, 0, 2}, 0.3), vec3(0), kLitUp, 0, u);
    EXPECT_EQ(moved.wi, still.wi);
    EXPECT_EQ(moved.pdf, still.pdf);
}

// On an unoccluded diffuse surface a light sampled by projected solid angle has no variance; that of a sphere cut by
// the horizon is what the fit leaves.
TEST_P(LightCase, ProjectedHasNoVariance) {
    const auto& [name, light, areaIsHopeless] = GetParam();
    if (light.kind == kLightEllipsoid) return; // sampled by the cone
    const double extent = light.kind == kLightSphere ? double(light.radius) : double(glm::length(light.edgeU));
    if (extent < 2e-3 * glm::length(dvec3(light.position))) return; // sampled otherwise
    const Mean mean = irradianceEstimates(light, kShapeProjected, 12, 1 << 15);
    EXPECT_LE(mean.relativeVariance(), light.kind == kLightSphere ? 1e-3 : 1e-10) << name;
}

// Relative variances of single samples of the irradiance, to 10 %.
TEST(Lights, VarianceOfSolidAngleAndAreaSampling) {
    const auto variance = [](const Light& light, uint method = kShapeSolidAngle) {
        return irradianceEstimates(light, method, 7, 1 << 18).relativeVariance();
    };
    EXPECT_NEAR(variance(quad({-1, -1, 0.5}, {2, 0, 0}, {0, 2, 0})), 0.059, 0.006);
    EXPECT_NEAR(variance(quad({0.05, -1, 0}, {0, 2, 0}, {0, 0, 2})), 0.34, 0.034);
    EXPECT_NEAR(variance(sphere({0, 0, 1}, 0.9)), 0.052, 0.005);
    EXPECT_NEAR(variance(sphere({0, std::cos(std::numbers::pi / 18), std::sin(std::numbers::pi / 18)}, 0.5)), 0.93,
                0.09);
    EXPECT_NEAR(variance(sphere({0, std::cos(std::numbers::pi / 18), -std::sin(std::numbers::pi / 18)}, 0.5)), 3.7,
                0.37);
    // What solid angle saves near lights; uniform in area it is tens to hundreds of times as much.
    EXPECT_NEAR(variance(quad({-1, -1, 0.5}, {2, 0, 0}, {0, 2, 0}), kShapeArea), 1.45, 0.15);
    EXPECT_NEAR(variance(sphere({0, 0, 1}, 0.2), kShapeArea), 2.8, 0.28);
    EXPECT_GT(variance(quad({0.05, -1, 0}, {0, 2, 0}, {0, 0, 2}), kShapeArea), 10.0);
    EXPECT_GT(variance(sphere({0, 0, 1}, 0.9), kShapeArea), 10.0);
}

} // namespace
} // namespace rt::shared
