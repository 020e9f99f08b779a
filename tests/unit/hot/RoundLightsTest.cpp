// Disks and cylinders as lights: against integrals over their surface in double, against each other, at extremes.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "Common/Scene/Compiler/LightTable.h"
#include "Common/Shared/Light/LightDensity.h"
#include "tests/unit/LightDraws.h"
#include "tests/unit/Oracles.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {
namespace {

using glm::dvec3;
using std::numbers::pi;
using test::agrees;
using test::Mean;
using test::Uniforms;

struct RoundCase {
    std::string name;
    Light light;
    bool areaIsHopeless = false; // unbounded weights: no standard error to test with
};

Light withSides(Light light, uint sides) {
    light.sides = sides;
    light.emission = vec3(1);
    return light;
}

Light ring(const dvec3& center, const dvec3& normal, double radius, double hole = 0) {
    const Frame frame = makeFrame(vec3(glm::normalize(normal)));
    const float r = static_cast<float>(radius);
    return withSides(scene::diskLight({vec3(center), frame.tangent * r, frame.bitangent * r, frame.normal,
                                       static_cast<float>(hole), 0, kNone}),
                     kSidesBoth);
}

Light ellipse(const dvec3& center, const dvec3& u, const dvec3& v) {
    return withSides(
        scene::diskLight({vec3(center), vec3(u), vec3(v), vec3(glm::normalize(glm::cross(u, v))), 0, 0, kNone}),
        kSidesBoth);
}

Light tube(const dvec3& base, const dvec3& axis, double radius, uint sides) {
    const Frame frame = makeFrame(vec3(glm::normalize(axis)));
    const float r = static_cast<float>(radius);
    return withSides(
        scene::cylinderLight({vec3(base), frame.tangent * r, frame.bitangent * r, vec3(axis), -1, 0, kNone}), sides);
}

Light slanted(const dvec3& base, const dvec3& u, const dvec3& v, const dvec3& axis) {
    return withSides(scene::cylinderLight({vec3(base), vec3(u), vec3(v), vec3(axis), -1, 0, kNone}), kSidesFront);
}

// The shading point is the origin, its normal +z.
std::vector<RoundCase> roundCases() {
    return {
        {"disk overhead", ring({0, 0, 1}, {0, 0, -1}, 1)},
        {"disk overhead far", ring({0.2, 0, 5}, {0, 0, -1}, 1)},
        {"disk very far", ring({3e3, 1e3, 6e3}, {1, 2, -3}, 1)},
        {"disk near", ring({0.3, 0.2, 0.1}, {0, 0.1, -1}, 1), true},
        {"disk beside", ring({2, 0.3, 1}, {-1, 0, 0.3}, 1)},
        {"disk across the horizon", ring({1, 0.3, 0.2}, {-1, 0.1, 0}, 0.8)},
        {"disk grazing", ring({2, 0.3, 0.2}, {0.1, 0.05, -1}, 1)},
        {"disk with a hole", ring({0.4, 0.2, 1}, {0.2, 0, -1}, 1, 0.3)},
        {"thin ring", ring({0.4, 0.2, 1}, {0.2, 0, -1}, 1, 0.9)},
        {"ellipse", ellipse({0.4, 0.2, 1}, {1, 0.2, 0}, {0.1, 0.4, 0.2})},
        {"tube beside", tube({1, -0.5, 0.2}, {0, 1, 0.4}, 0.3, kSidesFront)},
        {"tube near", tube({0.5, -1, 0.3}, {0.2, 2, 0.3}, 0.4, kSidesFront), true},
        {"tube far", tube({30, 5, 40}, {0, 2, 1}, 0.3, kSidesFront)},
        {"tube very far", tube({3e4, 5e3, 4e4}, {0, 2, 1}, 0.3, kSidesFront)},
        {"tube long and thin", tube({-10, 0.3, 1}, {20, 0, 0.5}, 0.01, kSidesFront)},
        {"tube short", tube({0.3, 0.2, 2}, {0, 0.02, 0.1}, 0.8, kSidesFront)},
        {"tube across the horizon", tube({1, 0.2, -1}, {0, 0, 2}, 0.5, kSidesFront)},
        {"tube seen from its end", tube({0.9, 0.1, 1}, {0.2, 0, 1.5}, 0.5, kSidesFront)},
        {"open tube from its end", tube({0.9, 0.1, 1}, {0.2, 0, 1.5}, 0.5, kSidesBoth)},
        {"open tube from below", tube({2.5, 0.1, 2}, {0, 0.3, -0.5}, 0.7, kSidesBoth)},
        {"open tube overhead", tube({0.1, 0.1, 1}, {0, 0, 1.5}, 0.5, kSidesBoth)},
        {"open tube around", tube({0.1, 0.2, -0.7}, {0.1, 0, 1.5}, 1, kSidesBoth)},
        {"slanted tube", slanted({1, 0.2, 0.5}, {0.5, 0.1, 0}, {0, 0.2, 0.1}, {0.3, 0, 1})},
    };
}

const std::array kRoundMethods{kShapeAuto, kShapeSolidAngle, kShapeProjected, kShapeArea};

// Whether the light itself is in the way of its sample, as the inside of a tube may be.
bool isHidden(const Light& light, const LightSample& s) {
    const float t = intersectRoundLight(light, vec3(0), 0, s.wi).distance;
    return t > 0 && t < 0.999f * s.distance; // by rounding a ray to the rim may pass by it
}

// Of the surface that is seen: integrals of the cosine at the origin (x) and of 1 (y) over solid angle.
constexpr int kCells = 6; // around, and across or along

std::size_t cellOf(double u, double v) {
    const auto cell = [](double x) { return std::clamp(static_cast<int>(x * kCells), 0, kCells - 1); };
    return static_cast<std::size_t>(cell(u) * kCells + cell(v));
}

struct Seen {
    double irradiance = 0, solidAngle = 0;
    std::vector<double> cells = std::vector<double>(kCells * kCells); // solid angles, by texture coordinates

    void add(const dvec3& point, const dvec3& element, std::size_t cell) {
        const double d2 = glm::dot(point, point), d = std::sqrt(d2);
        const double omega = std::abs(glm::dot(element, point)) / (d * d2);
        solidAngle += omega;
        cells[cell] += omega;
        irradiance += omega * std::max(point.z / d, 0.0);
    }
};

Seen seenOfDisk(const Light& light) {
    constexpr int kSteps = 1000;
    const dvec3 o(light.position), u(light.edgeU), v(light.edgeV);
    const double hole = light.radius;
    Seen seen;
    for (int i = 0; i < kSteps; ++i) {
        const double r = hole + (1 - hole) * (i + 0.5) / kSteps;
        for (int j = 0; j < kSteps; ++j) {
            const double turn = 2 * pi * (j + 0.5) / kSteps;
            seen.add(o + r * (std::cos(turn) * u + std::sin(turn) * v),
                     glm::cross(u, v) * (r * (1 - hole) / kSteps * 2 * pi / kSteps),
                     cellOf(turn / (2 * pi), (1 - r) / (1 - hole)));
        }
    }
    return seen;
}

// Whether a wall lies between the origin and a point of the tube: in the tube's own coordinates, where it is round.
bool isBehindAWall(const dvec3& start, const dvec3& end) {
    const dvec3 d = end - start;
    const double a = d.x * d.x + d.y * d.y, b = start.x * d.x + start.y * d.y;
    const double c = start.x * start.x + start.y * start.y - 1, root = b * b - a * c;
    if (root <= 0) return false;
    const double t = (-b - std::sqrt(root)) / a, z = start.z + t * d.z;
    return t > 0 && t < 1 - 1e-6 && z >= 0 && z <= 1;
}

Seen seenOfTube(const Light& light) {
    constexpr int kSteps = 1000;
    const dvec3 o(light.position), u(light.edgeU), v(light.edgeV), w(light.normal);
    const dvec3 start = glm::inverse(glm::dmat3(u, v, w)) * -o;
    Seen seen;
    for (int i = 0; i < kSteps; ++i) {
        const double turn = 2 * pi * (i + 0.5) / kSteps, x = std::cos(turn), y = std::sin(turn);
        const dvec3 element = glm::cross(x * v - y * u, w) * (2 * pi / kSteps / kSteps);
        for (int j = 0; j < kSteps; ++j) {
            const double z = (j + 0.5) / kSteps;
            const dvec3 point = o + x * u + y * v + z * w;
            const bool isOutside = x * (start.x - x) + y * (start.y - y) > 0;
            if (!isOutside && (light.sides != kSidesBoth || isBehindAWall(start, {x, y, z}))) continue;
            seen.add(point, element, cellOf(turn / (2 * pi), z));
        }
    }
    return seen;
}

Seen seenOf(const Light& light) {
    return light.kind == kLightDisk ? seenOfDisk(light) : seenOfTube(light);
}

class RoundLightCase : public testing::TestWithParam<RoundCase> {};

TEST_P(RoundLightCase, EstimatesAreIntegralsOverWhatIsSeen) {
    const auto& [name, light, areaIsHopeless] = GetParam();
    const Seen seen = seenOf(light);
    for (const uint method : kRoundMethods) {
        if (method == kShapeArea && areaIsHopeless) continue;
        for (const vec3 normal : {kLitUp, vec3(0)}) {
            Uniforms uniform(1);
            Mean mean;
            for (int i = 0; i < 1 << 16; ++i) {
                const LightSample s =
                    sampleLight(kFeatureAll, withMethod(method), light, vec3(0), normal, 0, uniform.pair());
                const double value = isSurface(normal) ? double(s.wi.z) : 1.0;
                mean.add(s.pdf > 0 && !isHidden(light, s) ? value / double(s.pdf) : 0);
            }
            const double truth = isSurface(normal) ? seen.irradiance : seen.solidAngle;
            EXPECT_TRUE(agrees(mean, truth, 1e-4)) << name << ", method " << method << ", normal " << normal.z;
        }
    }
}

// Chi-square: in each cell of the surface the samples' inverse densities come to the solid angle that is seen of it.
TEST_P(RoundLightCase, SamplesAreDistributedAsTheirDensitySays) {
    const auto& [name, light, areaIsHopeless] = GetParam();
    const Seen seen = seenOf(light);
    if (!(seen.solidAngle > 0)) return;
    for (const uint method : {kShapeAuto, kShapeSolidAngle}) {
        constexpr int kDraws = 1 << 16;
        std::vector<double> sums(seen.cells.size()), squares(seen.cells.size());
        Uniforms uniform(6);
        for (int i = 0; i < kDraws; ++i) {
            const LightSample s =
                sampleLight(kFeatureAll, withMethod(method), light, vec3(0), vec3(0), 0, uniform.pair());
            if (!(s.pdf > 0) || isHidden(light, s)) continue;
            const std::size_t cell = cellOf(double(s.uv.x), double(s.uv.y));
            sums[cell] += 1 / double(s.pdf);
            squares[cell] += 1 / (double(s.pdf) * double(s.pdf));
        }
        double statistic = 0;
        int cells = 0;
        for (std::size_t c = 0; c < sums.size(); ++c) {
            if (seen.cells[c] < 0.004 * seen.solidAngle) continue; // at silhouettes: few samples, coarse integrals
            const double mean = sums[c] / kDraws, variance = (squares[c] / kDraws - mean * mean) / kDraws;
            const double rounding = 2e-3 * seen.cells[c]; // of the integral
            statistic += std::pow(mean - seen.cells[c], 2) / (variance + rounding * rounding);
            ++cells;
        }
        EXPECT_GT(test::upperGamma(0.5 * cells, 0.5 * statistic), 1e-4) << name << ", method " << method;
    }
}

// By directions from all around: the density over all of them, each of which meets the light or not, is 1.
TEST_P(RoundLightCase, DensityIntegratesToOne) {
    const auto& [name, light, areaIsHopeless] = GetParam();
    if (name.find("far") != std::string::npos || name.find("thin") != std::string::npos) return;
    for (const uint method : {kShapeAuto, kShapeSolidAngle}) {
        for (const vec3 normal : {kLitUp, vec3(0)}) {
            Uniforms uniform(2);
            Mean mean;
            double inVain = 0;
            for (int i = 0; i < 1 << 17; ++i) {
                const vec3 wi = sampleSphere(uniform.pair());
                mean.add(4 * pi *
                         double(lightPdfAlong(kFeatureAll, withMethod(method), light, vec3(0), normal, 0, wi)));
            }
            // What samples are drawn in vain: in the hole, and by area on a side or behind a wall that is not seen.
            for (int i = 0; i < 1 << 15; ++i) {
                const LightSample s =
                    sampleLight(kFeatureAll, withMethod(method), light, vec3(0), vec3(0), 0, uniform.pair());
                inVain += !(s.pdf > 0) || isHidden(light, s);
            }
            if (isSurface(normal) && light.kind == kLightDisk && light.radius > 0) continue;
            inVain /= 1 << 15;
            EXPECT_NEAR(mean.mean(), 1 - inVain, 5 * mean.standardError() + 0.01)
                << name << ", method " << method << ", normal " << normal.z;
        }
    }
}

TEST_P(RoundLightCase, SampleIsOneGeometryAndItsDensity) {
    const auto& [name, light, areaIsHopeless] = GetParam();
    for (const uint method : kRoundMethods) {
        for (const vec3 normal : {kLitUp, vec3(0)}) {
            Uniforms uniform(3);
            int wrong = 0, missed = 0, count = 0;
            double point = 0;
            for (int i = 0; i < 1 << 13; ++i) {
                const LightSample s =
                    sampleLight(kFeatureAll, withMethod(method), light, vec3(0), normal, 0, uniform.pair());
                if (!(s.pdf > 0)) continue;
                ++count;
                const float again =
                    lightPdf(kFeatureAll, withMethod(method), light, vec3(0), normal, 0, s.wi, s.distance, s.normal);
                wrong += !(std::abs(double(again) / double(s.pdf) - 1) < 1e-3);
                point = std::max(point,
                                 glm::length(dvec3(s.point) - dvec3(s.wi) * double(s.distance)) / double(s.distance));
                const float t = intersectRoundLight(light, vec3(0), 0, s.wi).distance;
                missed += !(t > 0) || (t > 1.001f * s.distance);
            }
            // A direction does not tell the place on a curved surface so far away.
            const int allowed = method == kShapeArea && name == "tube very far" ? count : count / 200;
            EXPECT_LE(wrong, allowed) << name << ", method " << method << ", normal " << normal.z;
            EXPECT_LE(missed, count / 20) << name << ", method " << method << ", normal " << normal.z;
            EXPECT_LE(point, 2e-6) << name << ", method " << method;
        }
    }
}

// All lengths times 2^k: the same bits.
TEST_P(RoundLightCase, ScalesExactly) {
    const auto& [name, light, areaIsHopeless] = GetParam();
    for (const uint method : kRoundMethods) {
        for (const float scale : {0x1p-16f, 0x1p16f}) {
            const Light scaled = scaledLight(light, scale);
            Uniforms uniform(4);
            for (int i = 0; i < 256; ++i) {
                const vec2 u = uniform.pair();
                const LightSample a = sampleLight(kFeatureAll, withMethod(method), light, vec3(0), kLitUp, 0, u);
                const LightSample b = sampleLight(kFeatureAll, withMethod(method), scaled, vec3(0), kLitUp, 0, u);
                ASSERT_EQ(a.wi, b.wi) << name << ", method " << method;
                ASSERT_EQ(a.pdf, b.pdf) << name << ", method " << method;
            }
        }
    }
}

TEST_P(RoundLightCase, CornersOfTheUnitSquareAreFinite) {
    const auto& [name, light, areaIsHopeless] = GetParam();
    const float last = 0x0.ffffffp0f;
    for (const uint method : kRoundMethods) {
        for (const vec2 u : {vec2(0, 0), vec2(last, 0), vec2(0, last), vec2(last, last), vec2(0.5f, 0.5f)}) {
            const LightSample s = sampleLight(kFeatureAll, withMethod(method), light, vec3(0), vec3(0), 0, u);
            if (!(s.pdf > 0)) continue;
            EXPECT_TRUE(isFinite(s.wi) && isFinite(s.point) && isFinite(s.normal) && isFinite(s.pdf)) << name;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Rounds, RoundLightCase, testing::ValuesIn(roundCases()), [](const auto& info) {
    std::string name = info.param.name;
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
});

// The form factor of a disk on the axis: r^2 / (r^2 + h^2).
TEST(RoundLights, DiskOnItsAxisIsAnalytic) {
    for (const double h : {0.01, 0.1, 1.0, 10.0, 1000.0}) {
        const Light light = ring({0, 0, h}, {0, 0, -1}, 1);
        for (const uint method : {kShapeAuto, kShapeSolidAngle})
            EXPECT_TRUE(agrees(irradianceEstimates(light, method, 7, 1 << 14), pi / (1 + h * h), 1e-5)) << h;
    }
}

// Twelve decades of size and distance, on the axis, grazing, and in the plane: finite, and what is seen.
TEST(RoundLights, ExtremesAreFinite) {
    Uniforms uniform(8);
    int used = 0;
    for (const double size : {1e-9, 1e-4, 1.0, 1e4, 1e9}) {
        for (const double distance : {1e-6, 1e-3, 0.1, 1.0, 10.0, 1e3, 1e6}) {
            for (const double height : {0.0, 1e-9, 1e-5, 1e-2, 1.0}) {
                const dvec3 at = size * distance * glm::normalize(dvec3(1, 0.3, 0)) + dvec3(0, 0, size * height);
                for (const Light& light :
                     {ring(at, {0, 0, 1}, size), ring(at, {1, 0.1, 0.2}, size, 0.4),
                      tube(at, {0, 0, size}, size, kSidesBoth), tube(at, {size, 0, 0}, size, kSidesFront),
                      tube(at, {0, size, size}, 1e-3 * size, kSidesBoth)}) {
                    for (int i = 0; i < 64; ++i) {
                        const uint method = kRoundMethods[static_cast<std::size_t>(i) % kRoundMethods.size()];
                        const vec3 normal = i % 8 < 4 ? kLitUp : vec3(0);
                        const LightSample s =
                            sampleLight(kFeatureAll, withMethod(method), light, vec3(0), normal, 0, uniform.pair());
                        ASSERT_TRUE(s.pdf >= 0 && isFinite(s.pdf));
                        if (!(s.pdf > 0)) continue;
                        ++used;
                        ASSERT_TRUE(isFinite(s.wi) && isFinite(s.point) && isFinite(s.normal));
                        ASSERT_NEAR(glm::length(dvec3(s.wi)), 1, 1e-5);
                        const float again = lightPdf(kFeatureAll, withMethod(method), light, vec3(0), normal, 0, s.wi,
                                                     s.distance, s.normal);
                        ASSERT_TRUE(isFinite(again) && again >= 0);
                    }
                }
            }
        }
    }
    EXPECT_GT(used, 10000);
}

} // namespace
} // namespace rt::shared
