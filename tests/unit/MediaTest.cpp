#include <algorithm>
#include <limits>
#include <optional>

#include "Common/Shared/Medium/Media.h"
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

std::optional<std::pair<long double, long double>> exactSphere(const dvec3& o, const dvec3& d) {
    const long double a = (long double)d.x * d.x + (long double)d.y * d.y + (long double)d.z * d.z;
    const long double b = -((long double)o.x * d.x + (long double)o.y * d.y + (long double)o.z * d.z);
    const long double c = (long double)o.x * o.x + (long double)o.y * o.y + (long double)o.z * o.z - 1;
    const long double discriminant = b * b - a * c;
    if (discriminant <= 0) return std::nullopt;
    const long double root = std::sqrt(discriminant);
    return std::pair{(b - root) / a, (b + root) / a};
}

TEST(MediumSphere, IntervalFromAnyDistanceAndDirectionLength) {
    Uniforms uniform(1);
    int disagreements = 0;
    Mean squared;
    for (int i = 0; i < 1 << 17; ++i) {
        const double distance = uniform.logBetween(1e-3, 1e4);
        const vec3 o(glm::normalize(inBox(uniform, 1)) * distance);
        const dvec3 target = glm::normalize(inBox(uniform, 1)) * uniform.between(0, 1.2);
        const vec3 d(glm::normalize(target - dvec3(o)) * uniform.logBetween(1e-6, 1e6));
        const vec2 t = unitSphereInterval(o, d);
        ASSERT_TRUE(std::isfinite(t.x) && std::isfinite(t.y));
        const auto exact = exactSphere(dvec3(o), dvec3(d));
        const dvec3 closest = dvec3(o) - dvec3(d) * (glm::dot(dvec3(o), dvec3(d)) / glm::dot(dvec3(d), dvec3(d)));
        if (exact.has_value() != (t.x < t.y)) {
            ++disagreements;
            ASSERT_LE(std::abs(glm::length(closest) - 1), 4 * double(kEpsilon) * (1 + distance));
            continue;
        }
        if (!exact || distance < 2) continue;
        if (glm::length(closest) > 0.99) continue; // grazing: conditioned by the half chord
        squared.add(std::pow(double(t.x / exact->first) - 1, 2));
        squared.add(std::pow(double(t.y / exact->second) - 1, 2));
    }
    EXPECT_LE(std::sqrt(squared.mean()), 3e-7);
    EXPECT_LE(disagreements, 200);
}

TEST(MediumSphere, InsideAndAtSpecialPoints) {
    const vec2 center = unitSphereInterval(vec3(0), vec3(0, 0, 2));
    EXPECT_EQ(center, vec2(-0.5f, 0.5f));
    const vec2 surface = unitSphereInterval(vec3(0, 0, -1), vec3(0, 0, 1));
    EXPECT_EQ(surface, vec2(0, 2));
    const vec2 tangent = unitSphereInterval(vec3(0, 1, 0), vec3(0, 0, 1));
    EXPECT_GE(tangent.x, tangent.y);
    const vec2 behind = unitSphereInterval(vec3(0, 0, 5), vec3(0, 0, 1));
    EXPECT_EQ(behind, vec2(-6, -4));
    EXPECT_EQ(lengthWithin(behind, 100), 0.0f);
}

TEST(MediumBox, AxisParallelRaysOnEverySlab) {
    // A grid of origins on, between and outside the planes, both signs of every axis and of zero.
    for (const float a : {-2.0f, -1.0f, -0.5f, 0.0f, 1.0f, 3.0f}) {
        for (const float b : {-1.5f, -1.0f, 0.3f, 1.0f, 2.0f}) {
            for (int axis = 0; axis < 3; ++axis) {
                for (const float sign : {-1.0f, 1.0f}) {
                    for (const float zero : {-0.0f, 0.0f}) {
                        vec3 o, d(zero);
                        o[axis] = a, o[(axis + 1) % 3] = b, o[(axis + 2) % 3] = 0.25f;
                        d[axis] = sign;
                        const vec2 t = unitBoxInterval(o, d);
                        ASSERT_TRUE(!std::isnan(t.x) && !std::isnan(t.y));
                        if (std::abs(b) < 1) {
                            EXPECT_EQ(t, vec2(-1 - a * sign, 1 - a * sign));
                        }
                        if (std::abs(b) > 1) {
                            EXPECT_EQ(lengthWithin(t, 1e6f), 0.0f);
                        }
                    }
                }
            }
        }
    }
}

TEST(MediumBox, IntervalMatchesMembership) {
    Uniforms uniform(2);
    for (int i = 0; i < 1 << 16; ++i) {
        const vec3 o(inBox(uniform, 3));
        const vec3 d(glm::normalize(inBox(uniform, 1)) * uniform.logBetween(1e-3, 1e3));
        const vec2 t = unitBoxInterval(o, d);
        for (int k = 0; k < 4; ++k) {
            const double s = uniform.between(-6, 6) / glm::length(dvec3(d));
            const dvec3 p = glm::abs(dvec3(o) + dvec3(d) * s);
            const double depth = std::max({p.x, p.y, p.z}) - 1;
            if (std::abs(depth) < 1e-5) continue;
            ASSERT_EQ(s > double(t.x) && s < double(t.y), depth < 0) << i;
        }
    }
}

Medium mediumAt(uint shape, const dvec3& center, double halfSize, float extinction) {
    Medium m{};
    m.shape = shape;
    m.extinction = extinction;
    m.texture = kNone;
    for (int i = 0; i < 3; ++i) {
        m.toLocal[i] = vec4(0);
        m.toLocal[i][i] = float(1 / halfSize);
        m.toLocal[i].w = float(-center[i] / halfSize);
    }
    return m;
}

// Lengths are the world's whatever the size of the boundary, and nested boundaries need no gap.
TEST(Medium, IntervalIsInWorldLengths) {
    const Medium ball = mediumAt(kMediumSphere, {1, 2, 10}, 4, 0.1f);
    EXPECT_NEAR(lengthWithin(mediumInterval(ball, vec3(1, 2, 0), vec3(0, 0, 1)), 1e6f), 8, 1e-5);
    EXPECT_NEAR(lengthWithin(mediumInterval(ball, vec3(1, 2, 10), vec3(0, 0, 1)), 1e6f), 4, 1e-5);
    EXPECT_NEAR(lengthWithin(mediumInterval(ball, vec3(1, 2, 10), vec3(0, 0, 1)), 3), 3, 1e-6);
    EXPECT_EQ(lengthWithin(mediumInterval(ball, vec3(9, 2, 0), vec3(0, 0, 1)), 1e6f), 0.0f);
    const Medium box = mediumAt(kMediumBox, {0, 0, 0}, 2, 0.1f);
    EXPECT_NEAR(lengthWithin(mediumInterval(box, vec3(-10, 0.5f, 0.5f), vec3(1, 0, 0)), 1e6f), 4, 1e-5);
}

TEST(FreeFlight, CollidesWithTheRightProbability) {
    for (const double depth : {0.1, 1.0, 5.0}) {
        Uniforms uniform(3);
        Mean collides;
        for (int i = 0; i < 1 << 17; ++i) collides.add(sampleFreeFlight(uniform(), float(depth)) < 1.0f);
        EXPECT_TRUE(agrees(collides, -std::expm1(-depth))) << depth;
        EXPECT_NEAR(collisionProbability(float(depth)), -std::expm1(-depth), 3e-7);
    }
}

TEST(FreeFlight, PositionsFollowTheLaw) {
    Uniforms uniform(4);
    const double extinction = 2;
    std::vector<std::uint64_t> counts(65);
    std::vector<double> weights(65);
    for (int k = 0; k < 64; ++k) weights[k] = std::exp(-extinction * k / 16.0) - std::exp(-extinction * (k + 1) / 16.0);
    weights[64] = std::exp(-extinction * 4);
    for (int i = 0; i < 1 << 19; ++i)
        ++counts[std::min(static_cast<int>(sampleFreeFlight(uniform(), float(extinction)) * 16), 64)];
    EXPECT_GT(chiSquareP(counts, weights), kSignificance);
}

// The flight is the exact inverse of the distribution even where it is far shorter than the resolution of 1 - u.
TEST(FreeFlight, ThinMediaKeepTheirDigits) {
    for (const double u : {1e-14, 3e-11, 1e-7, 0.5, 1 - 0x1p-24}) {
        const double exact = -std::log1p(-double(float(u)));
        EXPECT_NEAR(sampleFreeFlight(float(u), 1) / exact, 1, 3e-7);
        EXPECT_NEAR(sampleFreeFlight(float(u), 1e-6f) / (exact / double(1e-6f)), 1, 4e-7);
    }
    EXPECT_EQ(sampleFreeFlight(0, 1), 0.0f);
}

TEST(Transmittance, IsAccurateFromThinToThick) {
    for (const double depth : {0.0, 1e-6, 1e-3, 0.5, 3.0, 20.0, 80.0}) {
        EXPECT_NEAR(transmittance(float(depth)), std::exp(-depth), 4e-7 * std::exp(-depth));
        EXPECT_NEAR(collisionProbability(float(depth)), -std::expm1(-depth), 4e-7 * -std::expm1(-depth));
    }
    EXPECT_LT(transmittance(1e30f), 1e-37f);
}

// Mean transmittance of a ball under diffuse light: 2 / tau^2 (1 - (1 + tau) exp(-tau)), tau = 2 sigma r.
TEST(Transmittance, OfABallUnderDiffuseLight) {
    for (const auto& [sigma, expected] : {std::pair{0.1, 0.876155}, {1.0, 0.296997}, {5.0, 0.019990}}) {
        const Medium ball = mediumAt(kMediumSphere, {0, 0, 0}, 1, float(sigma));
        Uniforms uniform(5);
        Mean mean;
        for (int i = 0; i < 1 << 16; ++i) {
            const vec3 d = -sampleCosineHemisphere(uniform.pair());
            const float length = lengthWithin(mediumInterval(ball, vec3(0, 0, 1), d), 1e6f);
            mean.add(transmittance(ball.extinction * length));
        }
        EXPECT_TRUE(agrees(mean, expected)) << sigma;
    }
}

} // namespace
} // namespace rt::shared
