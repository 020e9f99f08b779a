#include "Common/Probe/ChiSquare.h"

#include <cmath>
#include <limits>
#include <numeric>

namespace rt::probe {
namespace {

constexpr double kMinExpected = 5; // expected counts in a pool
constexpr int kMaxTerms = 10000;

// The regularised lower incomplete gamma function by its series, for x < a + 1.
double lowerGamma(double a, double x) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < kMaxTerms && term > sum * 1e-15; ++n) {
        term *= x / (a + n);
        sum += term;
    }
    return sum * std::exp(-x + a * std::log(x) - std::lgamma(a));
}

// The upper one by its continued fraction (Lentz 1976), for x >= a + 1.
double upperGamma(double a, double x) {
    const double tiny = std::numeric_limits<double>::min() / 1e-15;
    double b = x + 1 - a, c = 1 / tiny, d = 1 / b, product = d;
    for (int n = 1; n < kMaxTerms; ++n) {
        const double factor = -n * (n - a);
        b += 2;
        d = factor * d + b;
        c = b + factor / c;
        d = 1 / (d == 0 ? tiny : d);
        c = c == 0 ? tiny : c;
        product *= d * c;
        if (std::abs(d * c - 1) < 1e-15) break;
    }
    return product * std::exp(-x + a * std::log(x) - std::lgamma(a));
}

} // namespace

double chiSquareTail(double x, double degrees) {
    if (!(x > 0)) return 1;
    const double a = degrees / 2, half = x / 2;
    return half < a + 1 ? 1 - lowerGamma(a, half) : upperGamma(a, half);
}

std::optional<ChiSquare> chiSquare(std::span<const double> counts, std::span<const double> expectations,
                                   std::span<const double> errors) {
    const double counted = std::accumulate(counts.begin(), counts.end(), 0.0);
    const double expected = std::accumulate(expectations.begin(), expectations.end(), 0.0);
    if (!(expected > 0)) return std::nullopt;
    const double scale = counted / expected;
    std::size_t pools = 0;
    double statistic = 0, uncertainty = 0, count = 0, expectation = 0, variance = 0, left = counted;
    const auto close = [&] {
        const double difference = count - expectation;
        statistic += difference * difference / (expectation + variance);
        uncertainty += variance / (expectation + variance);
        ++pools;
        count = expectation = variance = 0;
    };
    for (std::size_t i = 0; i < counts.size(); ++i) {
        count += counts[i];
        expectation += expectations[i] * scale;
        if (!errors.empty()) variance += errors[i] * scale * errors[i] * scale;
        left -= expectations[i] * scale;
        if (expectation >= kMinExpected && left >= kMinExpected) close();
    }
    if (expectation > 0) close();
    if (pools < 2) return std::nullopt;
    return ChiSquare{statistic, pools - 1, chiSquareTail(statistic, static_cast<double>(pools - 1)),
                     uncertainty / static_cast<double>(pools)};
}

} // namespace rt::probe
