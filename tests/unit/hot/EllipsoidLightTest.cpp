// What spheres become under maps that scale unequally: the density of their directions, and stress.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <glm/matrix.hpp>

#include "Common/Shared/Light/LightDensity.h"
#include "tests/unit/LightDraws.h"
#include "tests/unit/LightShapes.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {
namespace {

using glm::dmat3;
using glm::dvec3;
using test::agrees;
using test::Mean;
using test::Uniforms;

dvec3 unitVector(Uniforms& uniform) {
    const vec2 u = uniform.pair();
    const double z = 1 - 2 * double(u.x), r = std::sqrt(std::max(1 - z * z, 0.0)),
                 phi = 2 * std::numbers::pi * double(u.y);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

// Columns at right angles to each other, right-handed.
dmat3 rotation(Uniforms& uniform) {
    const dvec3 z = unitVector(uniform), x = glm::normalize(glm::cross(z, unitVector(uniform)));
    return {x, glm::cross(z, x), z};
}

// Half axes in these proportions, turned; sheared as well if the unit sphere is turned before.
dmat3 turned(Uniforms& uniform, const dvec3& axes, bool isSheared) {
    const dmat3 scale(axes.x, 0, 0, 0, axes.y, 0, 0, 0, axes.z);
    const dmat3 map = rotation(uniform) * scale;
    return isSheared ? map * rotation(uniform) : map;
}

struct Shape {
    dvec3 axes;
    bool isSheared;
    dvec3 center;
};

const std::vector<Shape> kShapes = {
    {{1, 10, 0.1}, false, {2, 5, 7}},       {{1, 10, 0.1}, true, {2, 5, 7}},    {{-1, 2, 0.5}, true, {0.5, 2, 1}},
    {{0.3, 0.3, 0.01}, false, {0.1, 0, 1}}, {{0.05, 0.05, 1}, true, {1, 1, 1}}, {{1, 1, 1}, false, {3, 0, 0}},
};

// ---- the density of directions -------------------------------------------------------------------------------------

// The ratio of the solid angles of a small triangle of directions before and after the map, from the stretched cone, in
// which they are uniform.
TEST(Ellipsoids, DensityOfDirectionsIsTheJacobianOfTheirMap) {
    Uniforms uniform(1);
    for (int i = 0; i < 2000; ++i) {
        const dmat3 map = turned(uniform, {uniform.logBetween(0.1, 10), uniform.logBetween(0.1, 10), 1}, (i & 1) != 0);
        const Ellipsoid e = makeEllipsoid(vec3(map[0]), vec3(map[1]), vec3(map[2]));
        const dvec3 center = unitVector(uniform) * (1 + uniform.logBetween(0.01, 100));
        const EllipsoidCone cone = makeEllipsoidCone(e, vec3(center));
        const dvec3 axis(cone.axis);
        const dmat3 relax = dmat3(1) + (1 / double(cone.stretch) - 1) * glm::outerProduct(axis, axis);
        const dvec3 side = glm::normalize(glm::cross(axis, unitVector(uniform)));
        const double sine = std::sqrt((1 - double(cone.cosine)) * (1 + double(cone.cosine)));
        const dvec3 w = glm::normalize(axis + side * (sine / double(cone.cosine) * double(uniform())));
        const dvec3 x = glm::normalize(glm::cross(w, unitVector(uniform))) * 1e-5, y = glm::cross(w, x);
        const dvec3 a = w - x - y, b = w + 2.0 * x - y, c = w - x + 2.0 * y; // around w
        const auto mapped = [&](const dvec3& v) { return map * (relax * v); };
        const double before = test::triangleSolidAngle(a, b, c);
        const double after = test::triangleSolidAngle(mapped(a), mapped(b), mapped(c));
        const double density = double(ellipsoidConePdf(e, cone, vec3(glm::normalize(mapped(w)))));
        ASSERT_NEAR(density * 2 * std::numbers::pi * double(cone.oneMinusCosine) * after / before, 1, 2e-3) << i;
        // Around the axis solid angles are kept.
        const auto turnedToAxis = [&](const dvec3& v) { return mapped(axis + 1e-5 * v); };
        const dvec3 top = glm::cross(axis, side), p(0.5 * side), q(0.5 * top - 0.5 * side), r(-0.5 * top);
        const double kept = test::triangleSolidAngle(turnedToAxis(p), turnedToAxis(q), turnedToAxis(r)) /
                            test::triangleSolidAngle(axis + 1e-5 * p, axis + 1e-5 * q, axis + 1e-5 * r);
        ASSERT_NEAR(kept, 1, 1e-3) << i;
    }
}

// The outline is the edge of the cone: draws at its rim run along it, and those of the middle through the centre.
TEST(Ellipsoids, DrawsReachFromTheCentreToTheOutline) {
    Uniforms uniform(9);
    for (int i = 0; i < 200; ++i) {
        const dmat3 axes = turned(uniform, {uniform.logBetween(0.1, 10), uniform.logBetween(0.1, 10), 1}, (i & 1) != 0);
        const Light light = ellipsoid(axes * unitVector(uniform) * uniform.between(1.2, 20), axes);
        const dmat3 back = glm::inverse(dmat3(light.edgeU, light.edgeV, light.normal));
        const dvec3 center = back * dvec3(light.position);
        const auto nearest = [&](float u) { // of the ray to the sphere's centre
            const LightSample s =
                sampleLight(kFeatureAll, withMethod(kShapeSolidAngle), light, vec3(0), vec3(0), 0, vec2(u, uniform()));
            const dvec3 w = glm::normalize(back * dvec3(s.wi));
            return glm::length(glm::cross(center, w));
        };
        EXPECT_LT(nearest(0), 1e-4);
        EXPECT_NEAR(nearest(0x0.ffffffp0f), 1, 1e-3);
    }
}

// Counts in cells of directions against the density that multiple importance sampling asks for.
TEST(Ellipsoids, DrawsHaveTheDistributionOfTheDensity) {
    constexpr int kCells = 12, kFine = 100, kDraws = 1 << 19;
    Uniforms uniform(2);
    for (const Shape& shape : kShapes) {
        const Light light = ellipsoid(shape.center, turned(uniform, shape.axes, shape.isSheared));
        const dmat3 axes(light.edgeU, light.edgeV, light.normal);
        const RenderParams params = withMethod(kShapeSolidAngle);
        // Cells: squares of the tangent plane around the centre that hold the outline.
        const dvec3 center(light.position), z = glm::normalize(center);
        const dvec3 x = glm::normalize(glm::cross(z, dvec3(0.3, 0.2, 1))), y = glm::cross(z, x);
        double extent = 0;
        for (const dvec3& p : test::ellipsoidOutline(center, axes)) {
            ASSERT_GT(glm::dot(p, z), 0);
            extent = std::max(
                {extent, std::abs(glm::dot(p, x) / glm::dot(p, z)), std::abs(glm::dot(p, y) / glm::dot(p, z))});
        }
        std::vector<double> expected(kCells * kCells);
        const double step = 2 * extent / (kCells * kFine);
        for (int i = 0; i < kCells * kFine; ++i)
            for (int k = 0; k < kCells * kFine; ++k) {
                const double a = -extent + (i + 0.5) * step, b = -extent + (k + 0.5) * step;
                const double d2 = 1 + a * a + b * b;
                const vec3 v((z + x * a + y * b) / std::sqrt(d2));
                const double density = lightPdfAlong(kFeatureAll, params, light, vec3(0), vec3(0), 0, v);
                expected[static_cast<std::size_t>(i / kFine * kCells + k / kFine)] +=
                    density / (d2 * std::sqrt(d2)) * step * step;
            }
        const double whole = std::accumulate(expected.begin(), expected.end(), 0.0);
        EXPECT_NEAR(whole, 1, 2e-3);
        std::vector<std::uint64_t> counts(expected.size());
        for (int i = 0; i < kDraws; ++i) {
            const LightSample s = sampleLight(kFeatureAll, params, light, vec3(0), vec3(0), 0, uniform.pair());
            ASSERT_GT(s.pdf, 0);
            const dvec3 v(s.wi);
            const auto cell = [&](const dvec3& across) {
                const double at = (glm::dot(v, across) / glm::dot(v, z) + extent) / (2 * extent) * kCells;
                return std::clamp(static_cast<int>(at), 0, kCells - 1);
            };
            ++counts[static_cast<std::size_t>(cell(x) * kCells + cell(y))];
        }
        // Where the outline cuts a cell its expectation is known to a few thousandths: that counts as noise.
        const auto probability = [&](double bug) {
            double statistic = 0;
            int cells = 0;
            for (std::size_t c = 0; c < counts.size(); ++c) {
                const double mean = expected[c] * kDraws * (c % 2 == 0 ? 1 + bug : 1);
                if (mean < 20) continue;
                const double off = static_cast<double>(counts[c]) - mean;
                statistic += off * off / (mean + 4e-6 * mean * mean);
                ++cells;
            }
            return test::upperGamma(0.5 * cells, 0.5 * statistic);
        };
        EXPECT_GT(probability(0), test::kSignificance);
        EXPECT_LT(probability(0.05), test::kSignificance) << "a density 5 % off in every second cell is not seen";
    }
}

// Relative variances of single samples of the irradiance under the middle of a disk and of a needle, to 10 %. What
// looks round is sampled uniformly in solid angle; by area it is tens of times as much.
TEST(Ellipsoids, VarianceOfConesAndAreaSampling) {
    const auto variance = [](const dvec3& axes, double height, uint method) {
        const Light light = ellipsoid({0, 0, height}, {axes.x, 0, 0, 0, axes.y, 0, 0, 0, axes.z});
        return irradianceEstimates(light, method, 1, 1 << 18).relativeVariance();
    };
    const dvec3 disk(1, 1, 0.05), needle(1, 0.05, 0.05);
    EXPECT_NEAR(variance(disk, 1, kShapeAuto), 0.0098, 0.001);
    EXPECT_NEAR(variance(disk, 0.3, kShapeAuto), 0.104, 0.01);
    EXPECT_NEAR(variance(needle, 1, kShapeAuto), 0.098, 0.01);
    EXPECT_NEAR(variance(needle, 0.3, kShapeAuto), 1.1, 0.11);
    EXPECT_NEAR(variance(disk, 1, kShapeArea), 3.2, 0.32);
    EXPECT_GT(variance(disk, 0.3, kShapeArea), 10.0);
    EXPECT_NEAR(variance(needle, 1, kShapeArea), 2.5, 0.25);
}

// Over all directions, as the mixture asks for it.
TEST(Ellipsoids, DensityIntegratesToOne) {
    Uniforms uniform(3);
    for (const Shape& shape : kShapes) {
        const Light light = ellipsoid(0.4 * shape.center, turned(uniform, shape.axes, shape.isSheared));
        const dmat3 axes(light.edgeU, light.edgeV, light.normal);
        const bool isInside = glm::length(glm::inverse(axes) * dvec3(light.position)) <= 1;
        for (const uint method : {kShapeAuto, kShapeArea}) {
            if (isInside) continue;
            Mean mean;
            const auto outline = test::ellipsoidOutline(dvec3(light.position), axes);
            double lowest = 1; // directions from a cone around the axis that holds the outline
            const dvec3 z = glm::normalize(dvec3(light.position));
            for (const dvec3& p : outline) lowest = std::min(lowest, glm::dot(glm::normalize(p), z));
            const dvec3 x = glm::normalize(glm::cross(z, dvec3(0.3, 0.2, 1))), y = glm::cross(z, x);
            for (int i = 0; i < 1 << 18; ++i) {
                const vec2 u = uniform.pair();
                const double c = 1 - double(u.x) * (1 - lowest), r = std::sqrt(1 - c * c),
                             phi = 2 * std::numbers::pi * double(u.y);
                const dvec3 v = z * c + x * (r * std::cos(phi)) + y * (r * std::sin(phi));
                mean.add(2 * std::numbers::pi * (1 - lowest) *
                         double(lightPdfAlong(kFeatureAll, withMethod(method), light, vec3(0), vec3(0), 0, vec3(v))));
            }
            // Of points drawn by area those on the far side are of no use.
            const double d = glm::length(glm::inverse(axes) * dvec3(light.position));
            EXPECT_TRUE(agrees(mean, method == kShapeArea ? 0.5 * (1 - 1 / d) : 1.0, 1e-3)) << "method " << method;
        }
    }
}

// ---- inside, mirrored, one-sided -----------------------------------------------------------------------------------

TEST(Ellipsoids, FromInsideTheyFillAllDirections) {
    Uniforms uniform(4);
    const dmat3 axes = turned(uniform, {1, 10, -0.7}, true);
    for (const uint sides : {kSidesFront, kSidesBoth}) {
        const Light light = ellipsoid(axes * dvec3(0.3, -0.4, 0.2), axes, sides);
        Mean surface, medium;
        for (int i = 0; i < 1 << 14; ++i) {
            const vec2 u = uniform.pair();
            const LightSample s = sampleLight(kFeatureAll, withMethod(kShapeAuto), light, vec3(0), kLitUp, 0, u);
            if (sides == kSidesFront) {
                ASSERT_EQ(s.pdf, 0.0f);
                continue;
            }
            ASSERT_GT(s.pdf, 0.0f);
            surface.add(double(s.wi.z) / double(s.pdf));
            EXPECT_NEAR(glm::length(glm::inverse(axes) * (dvec3(s.point) - dvec3(light.position))), 1, 1e-5);
            EXPECT_GT(glm::dot(s.normal, s.wi), 0.0f); // outward
            EXPECT_NEAR(lightPdfAlong(kFeatureAll, withMethod(kShapeAuto), light, vec3(0), kLitUp, 0, s.wi), s.pdf,
                        1e-6f);
            const LightSample m = sampleLight(kFeatureAll, withMethod(kShapeAuto), light, vec3(0), vec3(0), 0, u);
            medium.add(1 / double(m.pdf));
            EXPECT_EQ(lightPdfAlong(kFeatureAll, withMethod(kShapeAuto), light, vec3(0), vec3(0), 0, m.wi), m.pdf);
        }
        if (sides == kSidesFront) continue;
        EXPECT_TRUE(agrees(surface, std::numbers::pi));
        EXPECT_TRUE(agrees(medium, 4 * std::numbers::pi));
    }
}

// A mirrored map leaves the sphere's front outside: samples and densities are those of the map before the mirror.
TEST(Ellipsoids, MirrorsChangeNothing) {
    Uniforms uniform(5);
    const dmat3 axes = turned(uniform, {1, 2, 0.5}, true);
    const Light light = ellipsoid({1, 2, 3}, axes);
    Light mirrored = light;
    mirrored.edgeV = -mirrored.edgeV;
    for (int i = 0; i < 1000; ++i) {
        const LightSample s =
            sampleLight(kFeatureAll, withMethod(kShapeAuto), mirrored, vec3(0), vec3(0), 0, uniform.pair());
        ASSERT_GT(s.pdf, 0);
        EXPECT_LT(glm::dot(s.normal, s.wi), 0);
        const float pdf =
            lightPdf(kFeatureAll, withMethod(kShapeAuto), light, vec3(0), vec3(0), 0, s.wi, s.distance, s.normal);
        EXPECT_NEAR(pdf / s.pdf, 1, 1e-4);
    }
}

// ---- stress --------------------------------------------------------------------------------------------------------

TEST(Ellipsoids, TwelveDecadesOfSizeDistanceAndShapeLeaveNothingThatIsNotFinite) {
    Uniforms uniform(6);
    std::uint64_t drawn = 0;
    for (int i = 0; i < 200000; ++i) {
        const double size = uniform.logBetween(1e-6, 1e6);
        const dvec3 axes =
            size * dvec3(uniform.logBetween(1e-4, 1), uniform.logBetween(1e-4, 1), uniform.logBetween(1e-4, 1));
        const dmat3 map = turned(uniform, axes, false);
        dvec3 center = unitVector(uniform) * uniform.logBetween(1e-6, 1e6);
        if (i % 4 == 0) center = map * (unitVector(uniform) * (1 + uniform.logBetween(1e-7, 1e-1))); // touching
        const dvec3 position = i % 8 < 4 ? dvec3(0) : dvec3(1e5, -2e5, 5e4);
        const Light light = ellipsoid(position + center, map, i & 1 ? kSidesFront : kSidesBoth);
        const vec3 normal = i % 3 == 0 ? vec3(0) : vec3(unitVector(uniform));
        const float last = 0x0.ffffffp0f;
        const vec2 u = i % 16 == 0 ? vec2(i & 32 ? last : 0.0f, i & 64 ? last : 0.0f) : uniform.pair();
        for (const uint method : {kShapeAuto, kShapeProjected, kShapeArea}) {
            const LightSample s = sampleLight(kFeatureAll, withMethod(method), light, vec3(position), normal, 0, u);
            ASSERT_TRUE(isFinite(s.pdf) && s.pdf >= 0) << i;
            if (!(s.pdf > 0)) continue;
            ++drawn;
            ASSERT_TRUE(isFinite(s.wi) && isFinite(s.point) && isFinite(s.normal) && isFinite(s.distance)) << i;
            ASSERT_NEAR(glm::length(s.wi), 1, 1e-4) << i;
            const float again =
                lightPdf(kFeatureAll, withMethod(method), light, vec3(position), normal, 0, s.wi, s.distance, s.normal);
            ASSERT_TRUE(isFinite(again) && again >= 0) << i;
            const float along = lightPdfAlong(kFeatureAll, withMethod(method), light, vec3(position), normal, 0, s.wi);
            ASSERT_TRUE(isFinite(along) && along >= 0) << i;
            ASSERT_TRUE(isFinite(lightPointError(kFeatureAll, light))) << i;
        }
    }
    EXPECT_GT(drawn, 200000u);
}

} // namespace
} // namespace rt::shared
