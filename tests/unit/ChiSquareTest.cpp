// Pearson's test against tabulated quantiles and against counts that do and do not follow their expectations.
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Probe/ChiSquare.h"

namespace rt::test {

namespace {

// Counts of n draws from the weights, and what is expected of other weights.
std::optional<probe::ChiSquare> drawn(const std::vector<double>& weights, const std::vector<double>& expectations,
                                      int n, const std::vector<double>& errors = {}) {
    std::mt19937_64 random(5);
    std::discrete_distribution<std::size_t> draw(weights.begin(), weights.end());
    std::vector<double> counts(weights.size());
    for (int i = 0; i < n; ++i) ++counts[draw(random)];
    return probe::chiSquare(counts, expectations, errors);
}

} // namespace

TEST(ChiSquare, TailsAreThoseOfTables) {
    EXPECT_NEAR(probe::chiSquareTail(3.841459, 1), 0.05, 1e-7);
    EXPECT_NEAR(probe::chiSquareTail(18.307038, 10), 0.05, 1e-7);
    EXPECT_NEAR(probe::chiSquareTail(23.209251, 10), 0.01, 1e-7);
    EXPECT_NEAR(probe::chiSquareTail(77.929465, 100), 0.95, 1e-6);
    for (const double x : {0.1, 2.0, 30.0}) EXPECT_NEAR(probe::chiSquareTail(x, 2), std::exp(-x / 2), 1e-12); // exact
    EXPECT_EQ(probe::chiSquareTail(0, 7), 1);
    EXPECT_NEAR(probe::chiSquareTail(1e6, 1e6), 0.5, 1e-3);
}

TEST(ChiSquare, FindsWhatDoesNotFollow) {
    std::vector<double> weights(400, 1), modulated(400);
    for (std::size_t i = 0; i < modulated.size(); ++i) modulated[i] = i % 2 == 0 ? 0.9 : 1.1;
    const auto same = drawn(weights, weights, 100000), other = drawn(modulated, weights, 100000);
    ASSERT_TRUE(same && other);
    EXPECT_EQ(same->degrees, 399u);
    EXPECT_GT(same->p, 1e-3);
    EXPECT_LT(other->p, 1e-20);
}

TEST(ChiSquare, PoolsWhatIsRare) {
    const std::vector<double> rare(1000, 1);
    const auto test = drawn(rare, rare, 1000);
    ASSERT_TRUE(test);
    EXPECT_EQ(test->degrees, 199u); // five cells a pool
    EXPECT_GT(test->p, 1e-3);
    // The expectations' sum does not count, and counts where none is expected do.
    EXPECT_EQ(probe::chiSquare(std::vector<double>{10, 30}, std::vector<double>{1, 3})->statistic, 0);
    EXPECT_GT(probe::chiSquare(std::vector<double>{20, 10, 20}, std::vector<double>{1, 0, 1})->statistic, 1);
}

// Expectations that are off by their errors, as often as not.
TEST(ChiSquare, ErrorsOfExpectationsAreVariance) {
    std::vector<double> weights(400, 1), guessed(400);
    const std::vector<double> errors(400, 0.1);
    std::mt19937_64 random(7);
    std::normal_distribution<double> error(0, 0.1);
    for (double& each : guessed) each = 1 + error(random);
    const auto exact = drawn(weights, guessed, 100000);
    EXPECT_LT(exact->p, 1e-6);
    EXPECT_EQ(exact->uncertainty, 0);
    const auto known = drawn(weights, guessed, 100000, errors);
    EXPECT_GT(known->p, 1e-3);
    EXPECT_NEAR(known->uncertainty, 0.7, 0.05); // 25^2 of 25^2 + 250
}

TEST(ChiSquare, TooLittleIsNoTest) {
    EXPECT_FALSE(probe::chiSquare(std::vector<double>{4, 4}, std::vector<double>{1, 1}));
    EXPECT_FALSE(probe::chiSquare(std::vector<double>{100}, std::vector<double>{1}));
    EXPECT_FALSE(probe::chiSquare(std::vector<double>{1, 2}, std::vector<double>{0, 0}));
}

} // namespace rt::test
