// Statistics for tests of random samplers: means with standard errors, chi-square, reproducible numbers.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include "Common/Shared/Base/Types.h"

namespace rt::test {

// Uniforms as the samplers get them: on the grid k 2^-24 in [0, 1 - 2^-24].
class Uniforms {
  public:
    explicit Uniforms(std::uint32_t seed) : engine_(seed) {}
    float operator()() { return static_cast<float>(engine_() >> 8) * 0x1p-24f; }
    shared::vec2 pair() {
        const float x = (*this)();
        return {x, (*this)()};
    }
    // Log-uniform in [low, high).
    double logBetween(double low, double high) { return low * std::pow(high / low, static_cast<double>((*this)())); }
    double between(double low, double high) { return low + (high - low) * static_cast<double>((*this)()); }
    std::uint32_t word() { return static_cast<std::uint32_t>(engine_()); }

  private:
    std::mt19937 engine_;
};

// Uniformly distributed in the cube [-extent, extent)^3.
inline glm::dvec3 inBox(Uniforms& uniform, double extent) {
    return {uniform.between(-extent, extent), uniform.between(-extent, extent), uniform.between(-extent, extent)};
}

// Uniformly distributed on the unit sphere.
inline glm::dvec3 randomDirection(Uniforms& uniform) {
    const double z = uniform.between(-1, 1), phi = uniform.between(0, 2 * std::numbers::pi), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

// Mean of independent samples and its standard error, by Welford's recurrence.
class Mean {
  public:
    void add(double x) {
        ++count_;
        const double delta = x - mean_;
        mean_ += delta / static_cast<double>(count_);
        squares_ += delta * (x - mean_);
    }
    double mean() const { return mean_; }
    double variance() const { return squares_ / static_cast<double>(count_ - 1); }
    double standardError() const { return std::sqrt(variance() / static_cast<double>(count_)); }
    double relativeVariance() const { return variance() / (mean_ * mean_); }

  private:
    std::size_t count_ = 0;
    double mean_ = 0;
    double squares_ = 0;
};

// |mean - expected| <= 4 standard errors, with an allowance for rounding that grows with the expected value.
inline testing::AssertionResult agrees(const Mean& mean, double expected, double rounding = 1e-5) {
    const double allowed = 4 * mean.standardError() + rounding * std::abs(expected);
    if (std::abs(mean.mean() - expected) <= allowed) return testing::AssertionSuccess();
    return testing::AssertionFailure() << mean.mean() << " is not within " << allowed << " of " << expected
                                       << " (z = " << (mean.mean() - expected) / mean.standardError() << ")";
}

// Q(a, x) = Gamma(a, x) / Gamma(a): series below the bend, Lentz's continued fraction above.
inline double upperGamma(double a, double x) {
    if (x <= 0) return 1;
    const double front = std::exp(-x + a * std::log(x) - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (double n = a + 1; term > sum * 1e-15; ++n) sum += term *= x / n;
        return 1 - front * sum;
    }
    double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
    for (int i = 1; i < 10000; ++i) {
        const double an = -i * (i - a);
        b += 2;
        d = 1 / (an * d + b);
        c = b + an / c;
        h *= c * d;
        if (std::abs(c * d - 1) < 1e-15) break;
    }
    return front * h;
}

// Probability of counts that deviate as much as these from expectations in the same proportions. Cells that expect
// fewer than 5 are pooled.
inline double chiSquareP(const std::vector<std::uint64_t>& counts, const std::vector<double>& weights) {
    const double total = static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}));
    const double whole = std::accumulate(weights.begin(), weights.end(), 0.0);
    double statistic = 0, pooledCount = 0, pooledExpected = 0;
    int cells = 0;
    const auto addCell = [&](double count, double expected) {
        statistic += (count - expected) * (count - expected) / expected;
        ++cells;
    };
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const double expected = total * weights[i] / whole;
        if (expected >= 5) {
            addCell(static_cast<double>(counts[i]), expected);
        } else {
            pooledCount += static_cast<double>(counts[i]);
            pooledExpected += expected;
        }
    }
    if (pooledExpected > 0) addCell(pooledCount, std::max(pooledExpected, 1e-9));
    return upperGamma(0.5 * (cells - 1), 0.5 * statistic);
}

inline double chiSquareP(const std::vector<std::uint64_t>& counts) {
    return chiSquareP(counts, std::vector<double>(counts.size(), 1.0));
}

constexpr double kSignificance = 1e-4;

} // namespace rt::test
