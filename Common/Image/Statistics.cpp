#include "Common/Image/Statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace rt::image {

namespace {

constexpr double kRoundingAllowance = 1e-5;

// Continued fraction of I_x(a, b) (DLMF 8.17.22), evaluated from the front by Lentz's method. Converges fast for
// x < (a + 1) / (a + b + 2).
double betaFraction(double a, double b, double x) {
    constexpr double kTiny = 1e-300;
    const auto nonzero = [](double value) { return std::abs(value) < kTiny ? kTiny : value; };
    double c = 1;
    double d = 1 / nonzero(1 - (a + b) * x / (a + 1));
    double fraction = d;
    for (int m = 1; m < 10000; ++m) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        d = 1 / nonzero(1 + even * d);
        c = nonzero(1 + even / c);
        fraction *= d * c;
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1 / nonzero(1 + odd * d);
        c = nonzero(1 + odd / c);
        fraction *= d * c;
        if (std::abs(d * c - 1) < 1e-15) break;
    }
    return fraction;
}

} // namespace

Estimate estimate(std::span<const double> samples) {
    const auto count = static_cast<double>(samples.size());
    const double mean = std::accumulate(samples.begin(), samples.end(), 0.0) / count;
    if (samples.size() < 2) return {mean, 0, 0};
    double squares = 0;
    for (const double sample : samples) squares += (sample - mean) * (sample - mean);
    return {mean, squares / (count - 1) / count, count - 1};
}

TTest welch(const Estimate& a, const Estimate& b) {
    const double variance = a.varianceOfMean + b.varianceOfMean;
    const double difference = a.mean - b.mean;
    if (variance <= 0) {
        const bool same = std::abs(difference) <= kRoundingAllowance * std::max(std::abs(a.mean), std::abs(b.mean));
        return same ? TTest{} : TTest{std::copysign(std::numeric_limits<double>::infinity(), difference), 0, 0};
    }
    const auto share = [](const Estimate& e) {
        return e.varianceOfMean > 0 ? e.varianceOfMean * e.varianceOfMean / e.dof : 0.0;
    };
    const double dof = variance * variance / (share(a) + share(b));
    const double t = difference / std::sqrt(variance);
    return {t, dof, studentTwoSided(t, dof)};
}

double studentTwoSided(double t, double dof) {
    return incompleteBeta(dof / 2, 0.5, dof / (dof + t * t));
}

double incompleteBeta(double a, double b, double x) {
    if (x <= 0) return 0;
    if (x >= 1) return 1;
    if (x > (a + 1) / (a + b + 2)) return 1 - incompleteBeta(b, a, 1 - x);
    const double logFactor =
        std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x);
    return std::exp(logFactor) * betaFraction(a, b, x) / a;
}

std::vector<std::size_t> discoveries(std::span<const double> pValues, double q) {
    std::vector<std::size_t> order(pValues.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return pValues[i] < pValues[j]; });
    const auto count = static_cast<double>(pValues.size());
    std::size_t rejected = order.size();
    while (rejected > 0 && pValues[order[rejected - 1]] > q * static_cast<double>(rejected) / count) --rejected;
    order.resize(rejected);
    std::sort(order.begin(), order.end());
    return order;
}

} // namespace rt::image
