#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "Common/Shared/Base/Sampling.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {
namespace {

using glm::dvec3;
using test::agrees;
using test::chiSquareP;
using test::kSignificance;
using test::Mean;
using test::Uniforms;

constexpr float kLast = 0x0.ffffffp0f; // the largest uniform
const std::array kCorners{vec2(0, 0), vec2(kLast, 0), vec2(0, kLast), vec2(kLast, kLast), vec2(0.5f, 0.5f)};

double frameError(const Frame& f) {
    const glm::dmat3 m(f.tangent, f.bitangent, f.normal);
    const glm::dmat3 gram = glm::transpose(m) * m;
    double worst = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) worst = std::max(worst, std::abs(gram[i][j] - (i == j)));
    return glm::determinant(m) > 0 ? worst : 1e30;
}

TEST(Sampling, FramesAreOrthonormalAndRightHanded) {
    Uniforms uniform(1);
    double worst = 0;
    for (int i = 0; i < 1 << 19; ++i) {
        dvec3 n = randomDirection(uniform);
        if (i & 1) n = glm::normalize(dvec3(n.x * 1e-4, n.y * 1e-4, n.z < 0 ? -1 : 1)); // the poles are the hard part
        if (i & 2) n = glm::normalize(dvec3(n.x, n.y, n.z * 1e-7));
        worst = std::max(worst, frameError(makeFrame(vec3(n))));
    }
    for (const vec3 n : {vec3(0, 0, 1), vec3(0, 0, -1), vec3(1, 0, 0.0f), vec3(1, 0, -0.0f), vec3(0, -1, -0.0f)})
        worst = std::max(worst, frameError(makeFrame(n)));
    EXPECT_LE(worst, 4e-7);
    // -0 is on the negative side: by the sign bit, so that every device branches alike.
    EXPECT_NE(makeFrame(vec3(0.6f, 0.8f, 0.0f)).tangent, makeFrame(vec3(0.6f, 0.8f, -0.0f)).tangent);
}

// The inverse of the concentric map, in double.
glm::dvec2 invertDisk(double x, double y) {
    const double r = std::hypot(x, y);
    double phi = std::atan2(y, x);
    if (phi < -std::numbers::pi / 4) phi += 2 * std::numbers::pi;
    const int sector = static_cast<int>(std::floor((phi + std::numbers::pi / 4) / (std::numbers::pi / 2)));
    const double t = (phi - sector * std::numbers::pi / 2) / (std::numbers::pi / 4);
    double a = 0, b = 0;
    switch (sector) {
        case 0:
            a = r, b = r * t;
            break;
        case 1:
            b = r, a = -r * t;
            break;
        case 2:
            a = -r, b = -r * t;
            break;
        default:
            b = -r, a = r * t;
            break;
    }
    return {(a + 1) / 2, (b + 1) / 2};
}

TEST(Sampling, DiskIsUniformAndInvertible) {
    Uniforms uniform(2);
    std::vector<std::uint64_t> counts(32 * 32);
    double worst = 0;
    for (int i = 0; i < 1 << 20; ++i) {
        const vec2 u = uniform.pair();
        const vec2 p = sampleDisk(u);
        const double r2 = double(p.x) * p.x + double(p.y) * p.y;
        ASSERT_LT(r2, 1);
        const int ring = static_cast<int>(r2 * 32);
        const int sector = static_cast<int>((std::atan2(p.y, p.x) / (2 * std::numbers::pi) + 0.5) * 32);
        ++counts[std::min(ring, 31) * 32 + std::min(sector, 31)];
        const glm::dvec2 back = invertDisk(p.x, p.y) - 0.5 * static_cast<double>(kEpsilon);
        worst = std::max({worst, std::abs(back.x - u.x), std::abs(back.y - u.y)});
    }
    EXPECT_GT(chiSquareP(counts), kSignificance);
    EXPECT_LE(worst, 2e-7);
    for (const vec2 u : kCorners) EXPECT_LT(glm::length(glm::dvec2(sampleDisk(u))), 1);
}

TEST(Sampling, CosineHemisphere) {
    Uniforms uniform(3);
    std::vector<std::uint64_t> counts(32 * 32);
    Mean cosine;
    double worstLength = 0;
    for (int i = 0; i < 1 << 20; ++i) {
        const vec3 w = sampleCosineHemisphere(uniform.pair());
        const double r2 = 1 - double(w.z) * w.z; // uniform under the cosine law
        const int sector = static_cast<int>((std::atan2(w.y, w.x) / (2 * std::numbers::pi) + 0.5) * 32);
        ++counts[std::clamp(static_cast<int>(r2 * 32), 0, 31) * 32 + std::min(sector, 31)];
        cosine.add(w.z);
        worstLength = std::max(worstLength, std::abs(glm::length(dvec3(w)) - 1));
    }
    EXPECT_GT(chiSquareP(counts), kSignificance);
    EXPECT_TRUE(agrees(cosine, 2.0 / 3));
    EXPECT_LE(worstLength, 3e-7);
    for (const vec2 u : kCorners) EXPECT_GE(sampleCosineHemisphere(u).z, 3e-4f);
}

// A planted error in the density must be seen: the same statistic with the cosine law replaced by one 2 % off.
TEST(Sampling, ChiSquareSeesTwoPercent) {
    Uniforms uniform(4);
    std::vector<std::uint64_t> counts(32);
    for (int i = 0; i < 1 << 20; ++i) {
        vec2 u = uniform.pair();
        u.x = u.x < 0.5f ? u.x * 0.98f : u.x;
        ++counts[static_cast<int>(u.x * 32)];
    }
    EXPECT_LT(chiSquareP(counts), kSignificance);
}

// Irradiance under the gradient sky A + B y is pi (A + 2/3 B n.y), whatever the frame.
TEST(Sampling, IrradianceOfAGradientSkyInAnyFrame) {
    Uniforms uniform(5);
    const double a = 0.75, b = 0.25;
    std::vector<dvec3> normals{{0, 0, 1}, {0, 0, -1}, {0, 1, 0}, {0.0072, 1, 0.0034}};
    for (int i = 0; i < 30; ++i) normals.push_back(randomDirection(uniform));
    for (const dvec3& n : normals) {
        const Frame frame = makeFrame(vec3(glm::normalize(n)));
        Mean irradiance;
        for (int i = 0; i < 1 << 14; ++i) {
            const vec3 w = toWorld(frame, sampleCosineHemisphere(uniform.pair()));
            irradiance.add(std::numbers::pi * (a + b * w.y));
        }
        EXPECT_TRUE(agrees(irradiance, std::numbers::pi * (a + b * 2 / 3 * glm::normalize(n).y)))
            << n.x << ' ' << n.y << ' ' << n.z;
    }
}

TEST(Sampling, Sphere) {
    Uniforms uniform(6);
    std::vector<std::uint64_t> counts(32 * 32);
    Mean secondMoment;
    double worstLength = 0;
    for (int i = 0; i < 1 << 20; ++i) {
        const vec3 w = sampleSphere(uniform.pair());
        const int sector = static_cast<int>((std::atan2(w.y, w.x) / (2 * std::numbers::pi) + 0.5) * 32);
        ++counts[std::clamp(static_cast<int>((w.z + 1) * 16), 0, 31) * 32 + std::min(sector, 31)];
        secondMoment.add(double(w.x) * w.x);
        worstLength = std::max(worstLength, std::abs(glm::length(dvec3(w)) - 1));
    }
    EXPECT_GT(chiSquareP(counts), kSignificance);
    EXPECT_TRUE(agrees(secondMoment, 1.0 / 3));
    EXPECT_LE(worstLength, 3e-7);
    for (const vec2 u : kCorners) EXPECT_NEAR(length(sampleSphere(u)), 1.0f, 3e-7f);
}

TEST(Sampling, HeuristicsSumToOneAndSurviveExtremes) {
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float a : {1e-30f, 1e-10f, 0.3f, 1.0f, 1e10f, 3e38f}) {
        for (const float b : {1e-30f, 1e-10f, 0.3f, 1.0f, 1e10f, 3e38f}) {
            EXPECT_NEAR(balanceHeuristic(a, b) + balanceHeuristic(b, a), 1.0f, 3e-7f);
            EXPECT_NEAR(powerHeuristic(a, b) + powerHeuristic(b, a), 1.0f, 3e-7f);
        }
        EXPECT_EQ(balanceHeuristic(a, 0), 1.0f);
        EXPECT_EQ(powerHeuristic(0, a), 0.0f);
        EXPECT_EQ(balanceHeuristic(infinity, a), 1.0f);
        EXPECT_EQ(powerHeuristic(a, infinity), 0.0f);
    }
    EXPECT_EQ(balanceHeuristic(0, 0), 0.0f);
    EXPECT_FLOAT_EQ(balanceHeuristic(3, 1), 0.75f);
    EXPECT_FLOAT_EQ(powerHeuristic(3, 1), 0.9f);
}

// The offset point must lie beyond every surface that the error admits, though it is rounded itself; and not much
// beyond.
TEST(Sampling, OffsetClearsTheErrorBox) {
    Uniforms uniform(7);
    for (int i = 0; i < 1 << 19; ++i) {
        const double far = i & 1 ? uniform.logBetween(1e-3, 1e5) : 0.0;
        const vec3 p(randomDirection(uniform) * far);
        const vec3 n(randomDirection(uniform));
        const vec3 error = abs(vec3(randomDirection(uniform))) * static_cast<float>(uniform.logBetween(1e-9, 1e-3));
        const vec3 w(randomDirection(uniform));
        const vec3 origin = offsetOrigin(p, error, n, w);
        const double side = dot(n, w) < 0 ? -1 : 1;
        const double clearance = side * glm::dot(dvec3(n), dvec3(origin) - dvec3(p));
        const double needed = glm::dot(glm::abs(dvec3(n)), dvec3(error));
        ASSERT_GE(clearance, needed * (1 - 1e-6)) << i;
        ASSERT_LE(clearance, needed * (1 + 1e-5) + 4e-7 * (std::abs(p.x) + std::abs(p.y) + std::abs(p.z)));
    }
}

TEST(Sampling, OffsetScalesExactly) {
    Uniforms uniform(8);
    for (int i = 0; i < 1000; ++i) {
        const vec3 p(randomDirection(uniform)), n(randomDirection(uniform)), w(randomDirection(uniform));
        const vec3 error = abs(p) * 1e-6f;
        for (const float scale : {0x1p-20f, 0x1p20f})
            ASSERT_EQ(offsetOrigin(p * scale, error * scale, n, w), offsetOrigin(p, error, n, w) * scale);
    }
}

} // namespace
} // namespace rt::shared
