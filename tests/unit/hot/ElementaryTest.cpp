#include <algorithm>
#include <limits>
#include <numbers>

#include "Common/Shared/Base/Elementary.h"
#include "Common/Shared/Texture/Color.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {
namespace {

using test::Uniforms;

double ulps(float value, double exact) {
    const double unit = std::ldexp(1.0, std::max(std::ilogb(exact), -126) - 23);
    return std::abs(static_cast<double>(value) - exact) / unit;
}

// Every number a sampler can draw.
TEST(Elementary, SinCos2PiOnTheWholeGrid) {
    double worst = 0, worstLength = 0;
    for (uint k = 0; k < 1u << 24; ++k) {
        const float u = static_cast<float>(k) * 0x1p-24f;
        const vec2 sc = sinCos2Pi(u);
        const double angle = 2 * std::numbers::pi * static_cast<double>(u);
        worst = std::max({worst, std::abs(sc.x - std::sin(angle)), std::abs(sc.y - std::cos(angle))});
        worstLength =
            std::max(worstLength, std::abs(static_cast<double>(sc.x) * sc.x + static_cast<double>(sc.y) * sc.y - 1));
    }
    EXPECT_LE(worst, 1.2e-7);
    EXPECT_LE(worstLength, 3e-7);
    EXPECT_EQ(sinCos2Pi(0.25f), vec2(1, 0));
    EXPECT_EQ(sinCos2Pi(0.5f), vec2(0, -1));
    EXPECT_EQ(sinCos2Pi(1.0f), vec2(0, 1));
}

TEST(Elementary, ArcTanInAllQuadrants) {
    Uniforms uniform(1);
    double worst = 0;
    for (int i = 0; i < 1 << 21; ++i) {
        const auto y = static_cast<float>((i & 1 ? -1 : 1) * uniform.logBetween(1e-12, 1e6));
        const auto x = static_cast<float>((i & 2 ? -1 : 1) * uniform.logBetween(1e-12, 1e6));
        const double exact = std::atan2(static_cast<double>(y), static_cast<double>(x));
        worst = std::max(worst, std::abs(arcTan(y, x) - exact) / std::abs(exact));
    }
    EXPECT_LE(worst, 3e-7);
    EXPECT_EQ(arcTan(0.0f, 0.0f), 0.0f);
    EXPECT_EQ(arcTan(0.0f, -1.0f), kPi);
    EXPECT_EQ(arcTan(-0.0f, -1.0f), -kPi);
    EXPECT_FLOAT_EQ(arcTan(1.0f, 0.0f), 0.5f * kPi);
}

TEST(Elementary, LogarithmsAndExponentials) {
    Uniforms uniform(2);
    double worstLog1p = 0, worstLog = 0, worstExpm1 = 0, worstExp = 0;
    for (int i = 0; i < 1 << 21; ++i) {
        const double sign = i & 1 ? -1 : 1;
        const auto small = static_cast<float>(sign * uniform.logBetween(1e-30, 0.99999));
        worstLog1p = std::max(worstLog1p, ulps(log1p(small), std::log1p(static_cast<double>(small))));
        const auto large = static_cast<float>(uniform.logBetween(1, 1e30));
        worstLog1p = std::max(worstLog1p, ulps(log1p(large), std::log1p(static_cast<double>(large))));
        const auto positive = static_cast<float>(uniform.logBetween(1e-37, 1e37));
        if (positive != 1.0f)
            worstLog = std::max(worstLog, ulps(logarithm(positive), std::log(static_cast<double>(positive))));
        const auto x = static_cast<float>(sign * uniform.logBetween(1e-30, 86));
        worstExpm1 = std::max(worstExpm1, ulps(expm1(x), std::expm1(static_cast<double>(x))));
        worstExp = std::max(worstExp, ulps(exponential(x), std::exp(static_cast<double>(x))));
    }
    EXPECT_LE(worstLog1p, 4);
    EXPECT_LE(worstLog, 4);
    EXPECT_LE(worstExpm1, 4);
    EXPECT_LE(worstExp, 4);
    EXPECT_EQ(log1p(0.0f), 0.0f);
    EXPECT_EQ(expm1(0.0f), 0.0f);
    EXPECT_EQ(exponential(0.0f), 1.0f);
    EXPECT_EQ(exponential(-1000.0f), exponential(-87.0f));
}

// The free flight takes -log1p(-u): every u must have a finite one that grows with u.
TEST(Elementary, LogOfTheGridIsMonotone) {
    float last = -1;
    for (uint k = 0; k < 1u << 24; k += 1) {
        const float flight = -log1p(-static_cast<float>(k) * 0x1p-24f);
        ASSERT_GE(flight, last) << k;
        last = flight;
    }
    EXPECT_FLOAT_EQ(last, 24 * 0.693147181f);
}

TEST(Elementary, FiniteAndSigns) {
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(isFinite(0.0f) && isFinite(-3.4e38f) && isFinite(1e-45f));
    EXPECT_FALSE(isFinite(infinity) || isFinite(-infinity) || isFinite(std::numeric_limits<float>::quiet_NaN()));
    EXPECT_TRUE(isFinite(vec3(1, 2, 3)));
    for (int i = 0; i < 3; ++i) {
        vec3 v(1);
        v[i] = infinity;
        EXPECT_FALSE(isFinite(v));
    }
    EXPECT_EQ(signOf(-0.0f), -1.0f);
    EXPECT_EQ(signOf(0.0f), 1.0f);
    EXPECT_EQ(signOf(-3.0f), -1.0f);
}

TEST(Elementary, SrgbOfEveryByte) {
    for (uint i = 0; i < 256; ++i) {
        const double c = i / 255.0;
        const double exact = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
        const vec3 decoded = decodeSrgb8(i | (255u - i) << 8u | 128u << 16u | 77u << 24u);
        EXPECT_NEAR(decoded.x, exact, 1e-6 * exact);
        EXPECT_EQ(decoded.y, decodeSrgb8(255u - i).x);
    }
    EXPECT_EQ(srgbToLinear(0.0f), 0.0f);
    EXPECT_NEAR(srgbToLinear(1.0f), 1.0f, 2e-7f);
}

} // namespace
} // namespace rt::shared
