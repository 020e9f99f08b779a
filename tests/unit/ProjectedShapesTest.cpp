// Samplers by projected solid angle against exact answers, over sizes, tilts and positions relative to the horizon.
#include <algorithm>
#include <string>
#include <vector>

#include "Common/Shared/Light/Projected/ProjectedPolygon.h"
#include "Common/Shared/Light/Projected/ProjectedSphere.h"
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

constexpr double kPiD = test::kPi;

dvec3 direction(Uniforms& uniform) {
    const double z = uniform.between(-1, 1), phi = uniform.between(0, 2 * kPiD), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

// ---- sphere ---------------------------------------------------------------------------------------------------------

struct Cap {
    vec3 toCenter;
    float radius;
    vec3 normal;
};

// A sphere of sine s = radius / distance whose centre is at the height rise * s above the horizon, turned anyhow.
Cap capAt(Uniforms& uniform, double s, double rise) {
    const dvec3 n = direction(uniform);
    const dvec3 t = glm::normalize(glm::cross(n, direction(uniform)));
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
            const double z = glm::dot(w, dvec3(c.normal)), y = glm::dot(w, dvec3(cap.side));
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

// ---- flat lights ----------------------------------------------------------------------------------------------------

struct Flat {
    vec3 corner, edgeU, edgeV, plane, normal;
    bool triangle;
    ProjectedFan fan() const { return makeProjectedFan(corner, edgeU, edgeV, plane, triangle, normal); }
    double irradiance() const {
        const dvec3 c(corner), u(edgeU), v(edgeV);
        return test::polygonIrradiance(
            triangle ? std::vector{c, c + u, c + v} : std::vector{c, c + u, c + u + v, c + v}, dvec3(normal));
    }
    vec3 towards(vec2 uv) const { return normalize(corner + edgeU * uv.x + edgeV * uv.y); }
};

FanSample draw(const ProjectedFan& fan, vec2 u) {
    FanQuery query{};
    query.use = kProjectedDraw;
    query.given = vec3(u, 0);
    query.normal = vec3(0, 0, 1); // of no account
    FanPick pick;
    return useProjectedFan(pick, fan, query);
}

float density(const ProjectedFan& fan, vec3 wi, vec3 normal) {
    FanQuery query{};
    query.use = kProjectedDensity;
    query.given = wi;
    query.normal = normal;
    FanPick pick;
    return useProjectedFan(pick, fan, query).density;
}

Flat flat(const dvec3& corner, const dvec3& u, const dvec3& v, bool triangle, const dvec3& normal) {
    return {vec3(corner), vec3(u), vec3(v), vec3(glm::normalize(glm::cross(dvec3(vec3(u)), dvec3(vec3(v))))),
            vec3(normal), triangle};
}

// Edges of size * thin to size.
Flat randomFlat(Uniforms& uniform, double size, double thin, bool triangle) {
    const dvec3 n = direction(uniform), u = direction(uniform) * size * uniform.logBetween(thin, 1),
                v = direction(uniform) * size * uniform.logBetween(thin, 1);
    return flat(direction(uniform) - 0.5 * (u + v), u, v, triangle, n);
}

class ProjectedFanOfSize : public testing::TestWithParam<double> {
  protected:
    // A part above the horizon of which rounding leaves little.
    static bool isMarginal(double irradiance) {
        return irradiance < 1e-5 * GetParam() * GetParam() * std::min(1.0, GetParam());
    }
};

void expectMeanIsTheIrradiance(const Flat& f, double rounding, Uniforms& uniform) {
    const ProjectedFan fan = f.fan();
    Mean mean;
    double lost = 0;
    for (int i = 0; i < 1 << 12; ++i) {
        const FanSample s = draw(fan, uniform.pair());
        ASSERT_TRUE(isFinite(s.density) && s.density >= 0 && isFinite(s.uv.x) && isFinite(s.uv.y));
        ASSERT_TRUE(s.uv.x >= 0 && s.uv.y >= 0 && s.uv.x <= 1 && s.uv.y <= 1);
        mean.add(s.density > 0 ? 1 / double(s.density) : 0);
        if (s.density > 0) lost += dot(f.towards(s.uv), f.normal) < -1e-6f;
    }
    // Weights far from 1 are rare, so their spread is not known from few samples: allow for 1e-3.
    const double exact = f.irradiance();
    EXPECT_NEAR(mean.mean() / exact, 1, 1e-3 + 5 * mean.standardError() / exact + rounding);
    EXPECT_EQ(lost, 0);
}

TEST_P(ProjectedFanOfSize, MeanIsTheIrradiance) {
    Uniforms uniform(3);
    for (int k = 0; k < 400; ++k) {
        const Flat f = randomFlat(uniform, GetParam(), 0.1, k % 2 == 0);
        if (isMarginal(f.irradiance())) continue;
        SCOPED_TRACE(k);
        // The height above the light's plane is known to 1e-7 of the distance.
        expectMeanIsTheIrradiance(f, 1e-7 / GetParam() + 3e-7 / double(f.fan().height), uniform);
        ASSERT_FALSE(HasFatalFailure());
    }
}

// Upright, and nearly in a plane with the receiver's normal.
TEST_P(ProjectedFanOfSize, MeanIsTheIrradianceOfLightsSeenEdgeOn) {
    Uniforms uniform(5);
    int lights = 0;
    for (const double height : {1e-2, 3e-3, 1e-3, 3e-4}) {
        for (int k = 0; k < 20; ++k) {
            const double s = GetParam();
            const dvec3 n = direction(uniform), side = glm::normalize(glm::cross(n, direction(uniform)));
            const dvec3 away = glm::cross(side, n);
            const auto edge = [&] {
                const double x = uniform.between(-s, s), y = uniform.between(-s, s);
                return x * away + y * n;
            };
            const dvec3 u = edge(), v = edge();
            const Flat f = flat(away + uniform.between(0.1, 1) * n + height * side, u, v, k % 2 == 0, n);
            if (isMarginal(f.irradiance()) || glm::length(glm::cross(u, v)) < 0.01 * s * s) continue;
            SCOPED_TRACE(std::to_string(height) + ", " + std::to_string(k));
            expectMeanIsTheIrradiance(f, 1e-6 / height, uniform);
            ASSERT_FALSE(HasFatalFailure());
            ++lights;
        }
    }
    EXPECT_GT(lights, 20);
}

// Of every light, slivers, grazing ones and those around the zenith included.
TEST_P(ProjectedFanOfSize, VarianceIsAtMostAThousandth) {
    Uniforms uniform(7);
    int lights = 0;
    for (int k = 0; k < 1200; ++k) {
        const Flat f = randomFlat(uniform, GetParam(), k % 3 == 0 ? 1e-3 : 0.1, k % 2 == 0);
        if (isMarginal(f.irradiance())) continue;
        const ProjectedFan fan = f.fan();
        // Densities depend on the first number alone. Its strata are as good as many more random numbers.
        Mean mean;
        for (int i = 0; i < 1 << 12; ++i) {
            const float u = (static_cast<float>(i) + uniform()) * 0x1p-12f;
            const FanSample s = draw(fan, vec2(u, uniform()));
            mean.add(s.density > 0 ? 1 / double(s.density) : 0);
        }
        EXPECT_LE(mean.relativeVariance(), 1e-3) << k;
        ++lights;
    }
    EXPECT_GT(lights, 500);
}

INSTANTIATE_TEST_SUITE_P(Sizes, ProjectedFanOfSize, testing::Values(1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0));

// Cells of equal area on the light, their exact measure by Lambert's formula; samples thinned by their weights.
TEST(ProjectedFan, WeightedCountsAreTheMeasure) {
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
        const ProjectedFan fan = f.fan();
        std::vector<std::uint64_t> counts(exact.size());
        for (int i = 0; i < 1 << 17; ++i) {
            const FanSample s = draw(fan, uniform.pair());
            ASSERT_GT(s.density, 0.0f) << k;
            if (uniform.between(0, 1.5) >= 1 / (double(s.density) * f.irradiance())) continue;
            int a = std::min(static_cast<int>(s.uv.x * kCells), kCells - 1);
            const int b = std::min(static_cast<int>(s.uv.y * kCells), kCells - 1);
            if (f.triangle && a + b >= kCells) a = kCells - 1 - b;
            ++counts[static_cast<std::size_t>(a * kCells + b)];
        }
        EXPECT_GT(chiSquareP(counts, exact), kSignificance) << "case " << k;
    }
}

// Strata stay strata: the mean of a smooth function over a jittered grid has a far smaller error than at random.
TEST(ProjectedFan, KeepsStrata) {
    Uniforms uniform(5);
    const Flat f = flat({0.5, -1, -0.3}, {0, 2, 0.3}, {0.4, 0, 2}, false, {0, 0, 1});
    const ProjectedFan fan = f.fan();
    const auto value = [&](vec2 u) {
        const FanSample s = draw(fan, u);
        return (double(s.uv.x) * 0.7 + double(s.uv.y) * double(s.uv.y)) / double(s.density);
    };
    Mean random, strata;
    constexpr int kSide = 16;
    for (int k = 0; k < 128; ++k) {
        double a = 0, b = 0;
        for (int i = 0; i < kSide * kSide; ++i) {
            const vec2 u = uniform.pair();
            a += value(u);
            b += value((u + vec2(static_cast<float>(i % kSide), static_cast<float>(i / kSide))) / float(kSide));
        }
        random.add(a), strata.add(b);
    }
    EXPECT_LT(strata.variance() * 16, random.variance());
}

// Twelve decades of size and of distance, from the light's plane, its corners and far from the origin.
TEST(ProjectedFan, StaysFiniteUnderStress) {
    Uniforms uniform(6);
    const float last = 0x0.ffffffp0f;
    for (int k = 0; k < 20000; ++k) {
        const double size = uniform.logBetween(1e-6, 1e6), thin = uniform.logBetween(1e-5, 1);
        const dvec3 n = direction(uniform), u = direction(uniform) * size;
        const dvec3 v = glm::normalize(glm::cross(u, direction(uniform))) * size * thin;
        dvec3 corner = direction(uniform) * uniform.logBetween(1e-6, 1e6);
        if (k % 4 == 0)
            corner = -0.3 * u - 0.4 * v + glm::normalize(glm::cross(u, v)) * size * uniform.logBetween(1e-6, 1);
        if (k % 16 == 1) corner = u * 0.1 + v; // in the light's plane
        if (k % 16 == 2) corner = n * size;    // a vertex at the zenith
        const Flat f = flat(corner, u, v, k % 2 == 0, n);
        const ProjectedFan fan = f.fan();
        for (const vec2 w : {uniform.pair(), vec2(0), vec2(last), vec2(0, last), vec2(last, 0)}) {
            const FanSample s = draw(fan, w);
            ASSERT_TRUE(isFinite(s.density) && s.density >= 0) << k;
            ASSERT_TRUE(s.uv.x >= 0 && s.uv.x <= 1 && s.uv.y >= 0 && s.uv.y <= 1) << k;
            if (s.density == 0) continue;
            const float again = density(fan, f.towards(s.uv), f.normal);
            ASSERT_TRUE(isFinite(again) && again >= 0) << k;
        }
    }
}

} // namespace
} // namespace rt::shared
