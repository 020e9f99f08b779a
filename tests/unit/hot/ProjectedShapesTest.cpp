// Samplers by projected solid angle against exact answers, over sizes, tilts and positions relative to the horizon.
#include <algorithm>
#include <string>
#include <vector>

#include "Common/Shared/Light/Projected/ProjectedLights.h"
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

// ---- sphere --------------------------------------------------------------------------------------------------------

struct Cap {
    vec3 toCenter;
    float radius;
    vec3 normal;
};

// A sphere of sine s = radius / distance whose centre is at the height rise * s above the horizon, turned anyhow.
Cap capAt(Uniforms& uniform, double s, double rise) {
    const dvec3 n = randomDirection(uniform);
    const dvec3 t = glm::normalize(glm::cross(n, randomDirection(uniform)));
    const double z = s * rise, distance = uniform.logBetween(1e-3, 1e3);
    const dvec3 c = (z * n + std::sqrt(std::max(0.0, 1 - z * z)) * t) * distance;
    return {vec3(c), static_cast<float>(s * distance), vec3(n)};
}

TEST(ProjectedCap, MeanIsTheProjectedSolidAngleAndVarianceIsThatOfTheFit) {
    Uniforms uniform(1);
    for (const double s : {1e-3, 1e-2, 0.05, 0.2, 0.5, 0.9, 0.99, 0.999}) {
        for (const double rise : {-0.99, -0.9, -0.5, -0.1, 0.0, 0.1, 0.5, 0.9, 0.999, 1.0, 1.001, 1.5, 5.0, 1e9}) {
            if (s * rise > 1 && rise < 1e9) continue;
            const Cap c = capAt(uniform, s, rise == 1e9 ? 1 / s : rise);
            const ProjectedCap cap = makeProjectedCap(makeSphereCone(c.toCenter, c.radius), c.normal);
            Mean mean;
            for (int i = 0; i < 1 << 13; ++i) {
                const ProjectedDirection d = sampleProjectedCap(cap, c.radius, uniform.pair());
                ASSERT_TRUE(isFinite(d.place.direction) && isFinite(d.density) && d.density > 0) << s << " " << rise;
                mean.add(1 / double(d.density));
                const double off = glm::length(dvec3(d.place.direction) * double(d.place.distance) - dvec3(c.toCenter));
                ASSERT_NEAR(off / double(c.radius), 1, 1e-6 / s);
                ASSERT_GE(dot(d.place.direction, c.normal), -2e-7f);
            }
            const double exact = test::sphereIrradiance(dvec3(c.toCenter), c.radius, dvec3(c.normal));
            // A height known to 1e-7 is a fraction of it of the cap; deeper, more of what is left.
            const double rounding = 1e-5 + 2e-7 / s / std::min(1.0, (1 + std::max(rise, -0.999)) * (1 + rise));
            EXPECT_TRUE(agrees(mean, exact, rounding)) << s << " " << rise;
            EXPECT_LE(mean.relativeVariance(), cap.kind == kCapWhole ? 1e-12 : 1e-3) << s << " " << rise;
        }
    }
}

// Cells in height above the horizon and across: exact shares by fine quadrature of the fit-free density.
TEST(ProjectedCap, WeightedCountsAreTheMeasure) {
    Uniforms uniform(2);
    for (const double rise : {-0.6, 0.4, 1.3}) {
        const Cap c = capAt(uniform, 0.4, rise);
        const SphereCone cone = makeSphereCone(c.toCenter, c.radius);
        const ProjectedCap cap = makeProjectedCap(cone, c.normal);
        constexpr int kCells = 6;
        std::vector<double> exact(kCells * kCells);
        const auto cellOf = [&](const dvec3& w) {
            const double z = glm::dot(w, dvec3(c.normal)), y = glm::dot(w, dvec3(cap.view.side));
            const int i = std::clamp(static_cast<int>(z / 0.95 * kCells), 0, kCells - 1);
            return i * kCells + std::clamp(static_cast<int>((y / 0.4 * 0.5 + 0.5) * kCells), 0, kCells - 1);
        };
        // Of directions uniform in the cone, weighed by the cosine: independent of the sampler under test.
        const int n = 1200;
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < n; ++k) {
                const vec2 u(static_cast<float>((i + 0.5) / n), static_cast<float>((k + 0.5) / n));
                const dvec3 w = dvec3(sampleSphereCone(cone, c.radius, u).direction);
                exact[static_cast<std::size_t>(cellOf(w))] += std::max(glm::dot(w, dvec3(c.normal)), 0.0);
            }
        // Samples thinned by their weights, which are near 1, have the ideal density.
        std::vector<std::uint64_t> counts(exact.size());
        const double whole = test::sphereIrradiance(dvec3(c.toCenter), c.radius, dvec3(c.normal));
        for (int i = 0; i < 1 << 18; ++i) {
            const ProjectedDirection d = sampleProjectedCap(cap, c.radius, uniform.pair());
            if (uniform.between(0, 1.5) < 1 / (double(d.density) * whole))
                ++counts[static_cast<std::size_t>(cellOf(dvec3(d.place.direction)))];
        }
        EXPECT_GT(chiSquareP(counts, exact), kSignificance) << rise;
    }
}

// Slices as an ellipse has them: no variance above the horizon, little where it cuts.
TEST(VisibleCap, MeanIsTheProjectedSolidAngleAndVarianceIsLittle) {
    Uniforms uniform(3);
    for (const double s : {0.04, 0.2, 0.5, 0.9, 0.99, 0.999}) {
        for (const double rise : {-0.99, -0.9, -0.5, -0.1, 0.0, 0.1, 0.5, 0.9, 0.999, 1.0, 1.001, 1.5, 5.0, 1e9}) {
            if (s * rise > 1 && rise < 1e9) continue;
            const Cap c = capAt(uniform, s, rise == 1e9 ? 1 / s : rise);
            const SphereCone cone = makeSphereCone(c.toCenter, c.radius);
            Mean mean;
            for (int i = 0; i < 1 << 13; ++i) {
                const VisibleCapSample d = sampleVisibleCap(cone, c.radius, c.normal, uniform.pair());
                ASSERT_TRUE(isFinite(d.place.direction) && isFinite(d.pdf) && d.pdf > 0) << s << " " << rise;
                const double cosine = std::max(double(dot(d.place.direction, c.normal)), 0.0);
                mean.add(cosine / double(d.pdf));
                const double off = glm::length(dvec3(d.place.direction) * double(d.place.distance) - dvec3(c.toCenter));
                ASSERT_NEAR(off / double(c.radius), 1, 1e-6 / s);
                // Of slivers a direction hardly tells the slice: heights are known to 1e-7.
                const double known = s * (1 + rise) < 1e-2 ? 0.5 : 0.1;
                ASSERT_NEAR(visibleCapPdf(cone, c.normal, d.place.direction) / d.pdf, 1, known) << s << " " << rise;
            }
            const double exact = test::sphereIrradiance(dvec3(c.toCenter), c.radius, dvec3(c.normal));
            // A height known to 1e-7 is a fraction of it of the cap; deeper, more of what is left.
            const double rounding = 3e-5 + 4e-7 / s / std::min(1.0, (1 + std::max(rise, -0.999)) * (1 + rise));
            EXPECT_TRUE(agrees(mean, exact, rounding)) << s << " " << rise;
            EXPECT_LE(mean.relativeVariance(), rise >= 1.001 ? 1e-6 : 0.2) << s << " " << rise;
        }
    }
}

// ---- flat lights ---------------------------------------------------------------------------------------------------

struct Flat {
    vec3 corner, edgeU, edgeV, plane, normal;
    bool triangle;
    ProjectedPolygon polygon() const { return makeProjectedPolygon(corner, edgeU, edgeV, plane, triangle, normal); }
    std::vector<dvec3> vertices() const {
        const dvec3 c(corner), u(edgeU), v(edgeV);
        return triangle ? std::vector{c, c + u, c + v} : std::vector{c, c + u, c + u + v, c + v};
    }
    double irradiance() const { return test::polygonIrradiance(vertices(), dvec3(normal)); }
    dvec3 point(const glm::dvec2& uv) const { return dvec3(corner) + dvec3(edgeU) * uv.x + dvec3(edgeV) * uv.y; }
    vec3 towards(vec2 uv) const { return normalize(corner + edgeU * uv.x + edgeV * uv.y); }
};

Flat flat(const dvec3& corner, const dvec3& u, const dvec3& v, bool triangle, const dvec3& normal) {
    return {vec3(corner), vec3(u), vec3(v), vec3(glm::normalize(glm::cross(dvec3(vec3(u)), dvec3(vec3(v))))),
            vec3(normal), triangle};
}

// Edges of size * thin to size.
Flat randomFlat(Uniforms& uniform, double size, double thin, bool triangle) {
    const dvec3 n = randomDirection(uniform), u = randomDirection(uniform) * size * uniform.logBetween(thin, 1),
                v = randomDirection(uniform) * size * uniform.logBetween(thin, 1);
    return flat(randomDirection(uniform) - 0.5 * (u + v), u, v, triangle, n);
}

class ProjectedPolygonOfSize : public testing::TestWithParam<double> {
  protected:
    // A part above the horizon of which rounding leaves little.
    static bool isMarginal(double irradiance) {
        return irradiance < 1e-5 * GetParam() * GetParam() * std::min(1.0, GetParam());
    }
};

// Rounding is that of single precision; of slivers and lights seen edge-on it costs digits, in few directions many.
void expectQuantiles(std::vector<double> errors, double ninetyNinePercent, double all) {
    ASSERT_GT(errors.size(), 20u);
    std::sort(errors.begin(), errors.end());
    EXPECT_LE(errors[errors.size() * 99 / 100], ninetyNinePercent);
    EXPECT_LE(errors.back(), all);
}

double errorOfTotal(const Flat& f, Uniforms& uniform) {
    const ProjectedPolygon polygon = f.polygon();
    for (int i = 0; i < 1 << 8; ++i) {
        const vec2 uv = sampleProjectedPolygon(polygon, uniform.pair());
        EXPECT_TRUE(uv.x >= 0 && uv.y >= 0 && uv.x <= 1 && uv.y <= 1);
        EXPECT_GE(dot(f.towards(uv), f.normal), -1e-6f);
    }
    return std::abs(double(polygon.total) / f.irradiance() - 1);
}

// Every weight is the total, so that this is the estimator's bias as well.
TEST_P(ProjectedPolygonOfSize, TotalIsTheIrradiance) {
    Uniforms uniform(3);
    std::vector<double> errors;
    for (int k = 0; k < 1500; ++k) {
        const Flat f = randomFlat(uniform, GetParam(), k % 3 == 0 ? 1e-3 : 0.1, k % 2 == 0);
        if (!isMarginal(f.irradiance())) errors.push_back(errorOfTotal(f, uniform));
    }
    expectQuantiles(errors, 1e-4 + 2e-7 / GetParam(), 3e-3);
}

// Upright, and nearly in a plane with the receiver's normal.
TEST_P(ProjectedPolygonOfSize, TotalIsTheIrradianceOfLightsSeenEdgeOn) {
    Uniforms uniform(5);
    for (const double height : {1e-2, 1e-3}) {
        std::vector<double> errors;
        for (int k = 0; k < 200; ++k) {
            const double s = GetParam();
            const dvec3 n = randomDirection(uniform), side = glm::normalize(glm::cross(n, randomDirection(uniform)));
            const dvec3 away = glm::cross(side, n);
            const auto edge = [&] {
                const double x = uniform.between(-s, s), y = uniform.between(-s, s);
                return x * away + y * n;
            };
            const dvec3 u = edge(), v = edge();
            const Flat f = flat(away + uniform.between(0.1, 1) * n + height * side, u, v, k % 2 == 0, n);
            if (isMarginal(f.irradiance()) || glm::length(glm::cross(u, v)) < 0.01 * s * s) continue;
            errors.push_back(errorOfTotal(f, uniform));
        }
        expectQuantiles(errors, 1e-5 / height, 3e-5 / height);
    }
}

// A sample stands at the place in the azimuth cdf that its number names: what lies before its slice, by Lambert's
// formula in double precision, is that share of the whole.
TEST_P(ProjectedPolygonOfSize, NumbersAreSharesOfTheAzimuthCdf) {
    Uniforms uniform(7);
    std::vector<double> errors;
    for (int k = 0; k < 1200; ++k) {
        const Flat f = randomFlat(uniform, GetParam(), k % 3 == 0 ? 1e-3 : 0.1, k % 2 == 0);
        const ProjectedPolygon polygon = f.polygon();
        if (isMarginal(f.irradiance()) || polygon.outline.central) continue;
        const dvec3 n(f.normal), first = f.point(polygon.outline.uv[polygon.outline.sector[0].x]);
        for (int i = 0; i < 16; ++i) {
            const vec2 u = uniform.pair();
            const dvec3 across = glm::cross(n, f.point(sampleProjectedPolygon(polygon, u)));
            const double before = test::polygonIrradiance(test::cutByPlane(f.vertices(), across, first), n);
            errors.push_back(std::abs(before / f.irradiance() - double(u.x)));
        }
    }
    expectQuantiles(errors, 3e-5 + 1e-7 / GetParam(), 5e-3);
}

INSTANTIATE_TEST_SUITE_P(Sizes, ProjectedPolygonOfSize, testing::Values(1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0));

// Cells of equal area on the light and their exact measure by Lambert's formula.
TEST(ProjectedPolygon, CountsAreTheMeasure) {
    Uniforms uniform(4);
    const dvec3 up(0, 0, 1);
    const std::vector<Flat> cases = {
        flat({-1, -0.7, 0.5}, {2, 0, 0.1}, {0, 1.6, 0}, false, up),  // the zenith inside
        flat({0.2, -0.7, 0.5}, {2, 0, 0.1}, {0, 1.6, 0}, false, up), // beside it
        flat({0.5, -1, -1}, {0, 2, 0.3}, {0.2, 0, 2}, false, up),    // across the horizon
        flat({1, -1, 0.2}, {0, 2, 0}, {0, 0, 1}, false, up),         // on a wall, upright edges
        flat({0.05, -1, 0}, {0, 2, 0}, {0, 0, 2}, false, up),        // from the floor next to it
        flat({-0.4, -0.5, 0.7}, {1.2, 0, 0}, {0.3, 1.1, 0.2}, true, up),
        flat({1, -1, -0.5}, {0, 2, 0}, {0.3, 1, 2}, true, up),
        flat({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, true, up), // a vertex at the zenith
    };
    for (std::size_t k = 0; k < cases.size(); ++k) {
        const Flat& f = cases[k];
        constexpr int kCells = 8;
        std::vector<double> exact(kCells * kCells);
        for (int i = 0; i < kCells; ++i)
            for (int j = 0; j < kCells; ++j) {
                const auto at = [&](double a, double b) {
                    return dvec3(f.corner) + dvec3(f.edgeU) * (a / kCells) + dvec3(f.edgeV) * (b / kCells);
                };
                double& cell = exact[static_cast<std::size_t>(i * kCells + j)];
                if (f.triangle && i + j >= kCells) continue;
                std::vector<dvec3> corners{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
                if (f.triangle && i + j == kCells - 1) corners.erase(corners.begin() + 2);
                cell = test::polygonIrradiance(corners, dvec3(f.normal));
            }
        const ProjectedPolygon polygon = f.polygon();
        EXPECT_NEAR(double(polygon.total) / f.irradiance(), 1, 1e-6) << k;
        std::vector<std::uint64_t> counts(exact.size());
        for (int i = 0; i < 1 << 18; ++i) {
            const vec2 uv = sampleProjectedPolygon(polygon, uniform.pair());
            int a = std::min(static_cast<int>(uv.x * kCells), kCells - 1);
            const int b = std::min(static_cast<int>(uv.y * kCells), kCells - 1);
            if (f.triangle && a + b >= kCells) a = kCells - 1 - b;
            ++counts[static_cast<std::size_t>(a * kCells + b)];
        }
        EXPECT_GT(chiSquareP(counts, exact), kSignificance) << "case " << k;
    }
}

// Strata stay strata: the mean of a smooth function over a jittered grid has a far smaller error than at random.
TEST(ProjectedPolygon, KeepsStrata) {
    Uniforms uniform(5);
    const Flat f = flat({0.5, -1, -0.3}, {0, 2, 0.3}, {0.4, 0, 2}, false, {0, 0, 1});
    const ProjectedPolygon polygon = f.polygon();
    const auto value = [&](vec2 u) {
        const vec2 uv = sampleProjectedPolygon(polygon, u);
        return double(uv.x) * 0.7 + double(uv.y) * double(uv.y);
    };
    Mean random, strata;
    constexpr int kSide = 16;
    for (int k = 0; k < 128; ++k) {
        double a = 0, b = 0;
        for (int i = 0; i < kSide * kSide; ++i) {
            const vec2 u = uniform.pair();
            a += value(u);
            const int column = i % kSide, row = i / kSide;
            b += value((u + vec2(static_cast<float>(column), static_cast<float>(row))) / float(kSide));
        }
        random.add(a), strata.add(b);
    }
    EXPECT_LT(strata.variance() * 16, random.variance());
}

// Twelve decades of size and of distance, from the light's plane, its corners and far from the origin.
TEST(ProjectedPolygon, StaysFiniteUnderStress) {
    Uniforms uniform(6);
    const float last = 0x0.ffffffp0f;
    for (int k = 0; k < 20000; ++k) {
        const double size = uniform.logBetween(1e-6, 1e6), thin = uniform.logBetween(1e-5, 1);
        const dvec3 n = randomDirection(uniform), u = randomDirection(uniform) * size;
        const dvec3 v = glm::normalize(glm::cross(u, randomDirection(uniform))) * size * thin;
        dvec3 corner = randomDirection(uniform) * uniform.logBetween(1e-6, 1e6);
        if (k % 4 == 0)
            corner = -0.3 * u - 0.4 * v + glm::normalize(glm::cross(u, v)) * size * uniform.logBetween(1e-6, 1);
        if (k % 16 == 1) corner = u * 0.1 + v; // in the light's plane
        if (k % 16 == 2) corner = n * size;    // a vertex at the zenith
        const Flat f = flat(corner, u, v, k % 2 == 0, n);
        const ProjectedPolygon polygon = f.polygon();
        ASSERT_TRUE(isFinite(polygon.total) && polygon.total >= 0 && polygon.total < 1.001f * kPi) << k;
        if (polygon.total == 0) continue;
        ASSERT_TRUE(isFinite(1 / polygon.total)) << k;
        for (const vec2 w : {uniform.pair(), vec2(0), vec2(last), vec2(0, last), vec2(last, 0)}) {
            const vec2 uv = sampleProjectedPolygon(polygon, w);
            ASSERT_TRUE(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1) << k;
        }
    }
}

} // namespace
} // namespace rt::shared
