#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Image/Convergence.h"
#include "Common/Image/Statistics.h"
#include "Common/Image/Summary.h"

namespace rt::image {
namespace {

std::vector<CurvePoint> powerLaw(double factor, double slope, std::initializer_list<double> xs) {
    std::vector<CurvePoint> points;
    for (const double x : xs) points.push_back({x, factor * std::pow(x, slope)});
    return points;
}

TEST(Convergence, FindsThePowerOfAPowerLaw) {
    for (const double slope : {-1.0, -1.5, -0.5}) {
        const auto fit = fitLogLog(powerLaw(3, slope, {1, 4, 16, 100}));
        ASSERT_TRUE(fit);
        EXPECT_NEAR(fit->slope, slope, 1e-12);
        EXPECT_NEAR(fit->intercept, std::log(3.0), 1e-12);
        EXPECT_NEAR(fit->slopeError.value(), 0, 1e-6);
    }
}

// By hand: points (0, 0), (1, -1), (2, 0) in logarithms have the slope 0 and residuals 1/3, -2/3, 1/3.
TEST(Convergence, SlopeErrorIsThatOfLeastSquares) {
    const double e = std::exp(1.0);
    const std::array<CurvePoint, 3> points = {{{1, 1}, {e, 1 / e}, {e * e, 1}}};
    const auto fit = fitLogLog(points);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->slope, 0, 1e-12);
    EXPECT_NEAR(fit->intercept, -1.0 / 3, 1e-12);
    EXPECT_NEAR(fit->slopeError.value(), std::sqrt((6.0 / 9) / 1 / 2), 1e-12);
}

TEST(Convergence, NeedsTwoPositivePoints) {
    EXPECT_FALSE(fitLogLog(powerLaw(1, -1, {5})));
    const std::array<CurvePoint, 2> negative = {{{1, 1}, {2, -1}}};
    EXPECT_FALSE(fitLogLog(negative));
    const std::array<CurvePoint, 2> same = {{{2, 1}, {2, 3}}};
    EXPECT_FALSE(fitLogLog(same));
    EXPECT_FALSE(fitLogLog(powerLaw(1, -1, {1, 2}))->slopeError);
}

TEST(Convergence, InterpolatesAndExtrapolates) {
    const auto points = powerLaw(8, -1, {1, 2, 8});
    const auto inside = errorAt(points, 4);
    ASSERT_TRUE(inside);
    EXPECT_NEAR(inside->value, 2, 1e-12);
    EXPECT_FALSE(inside->extrapolated);
    EXPECT_NEAR(errorAt(points, 16)->value, 0.5, 1e-12);
    EXPECT_TRUE(errorAt(points, 16)->extrapolated);
    EXPECT_NEAR(errorAt(points, 0.5)->value, 16, 1e-12);
    EXPECT_TRUE(errorAt(points, 0.5)->extrapolated);

    EXPECT_NEAR(whenBelow(points, 2)->value, 4, 1e-12);
    EXPECT_FALSE(whenBelow(points, 2)->extrapolated);
    EXPECT_NEAR(whenBelow(points, 0.1)->value, 80, 1e-9);
    EXPECT_TRUE(whenBelow(points, 0.1)->extrapolated);
    EXPECT_NEAR(whenBelow(points, 16)->value, 0.5, 1e-12);
    EXPECT_TRUE(whenBelow(points, 16)->extrapolated);
    EXPECT_FALSE(whenBelow({}, 1));
    EXPECT_FALSE(errorAt(points, 0));
}

// A curve that dips early and rises again has not arrived when it dips.
TEST(Convergence, LuckOnTheWayDoesNotCount) {
    const std::array<CurvePoint, 4> points = {{{1, 4}, {2, 0.5}, {4, 2}, {16, 0.5}}};
    const auto when = whenBelow(points, 1);
    ASSERT_TRUE(when);
    EXPECT_NEAR(when->value, 8, 1e-9);
}

TEST(Convergence, EfficiencyIsWhatASecondBuys) {
    EXPECT_DOUBLE_EQ(efficiency(0.5, 4).value(), 0.5);
    EXPECT_FALSE(efficiency(0, 4));
    EXPECT_FALSE(efficiency(-1e-9, 4));
    EXPECT_FALSE(efficiency(1, 0));
}

TEST(Summary, OfFewNumbers) {
    const std::array<double, 3> values = {3, 1, 8};
    const Summary summary = summarise(values);
    EXPECT_EQ(summary.count, 3u);
    EXPECT_DOUBLE_EQ(summary.mean, 4);
    EXPECT_DOUBLE_EQ(summary.median, 3);
    EXPECT_DOUBLE_EQ(summary.min, 1);
    EXPECT_DOUBLE_EQ(summary.max, 8);
    // Standard deviation sqrt(13), t of 95 % with two degrees of freedom 4.3027.
    EXPECT_NEAR(summary.halfWidth95, 4.302653 * std::sqrt(13.0 / 3), 1e-5);
    EXPECT_EQ(summarise({}).count, 0u);
    EXPECT_EQ(summarise(std::array<double, 1>{5}).halfWidth95, 0);
    EXPECT_DOUBLE_EQ(median({4, 1, 2, 3}), 2.5);
}

TEST(Summary, QuantilesAreThoseOfTables) {
    EXPECT_NEAR(studentQuantile(0.05, 1), 12.7062, 1e-4);
    EXPECT_NEAR(studentQuantile(0.05, 10), 2.22814, 1e-5);
    EXPECT_NEAR(studentQuantile(0.01, 4), 4.60409, 1e-5);
    EXPECT_NEAR(studentTwoSided(studentQuantile(0.2, 7), 7), 0.2, 1e-12);
}

} // namespace
} // namespace rt::image
