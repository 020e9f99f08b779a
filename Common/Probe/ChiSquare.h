// Pearson's test: do counts follow expectations?
#pragma once
#include <cstddef>
#include <optional>
#include <span>

namespace rt::probe {

struct ChiSquare {
    double statistic = 0;
    std::size_t degrees = 0; // of freedom
    double p = 1;            // probability of this statistic or more if the counts follow the expectations
    double uncertainty = 0;  // mean over pools: share of errors of the expectations in the variance
};

// Neighbouring cells are pooled until at least five counts are expected. The expectations' sum is taken for that of the
// counts. Nothing where fewer than two pools come of it. `errors`: standard errors of the expectations, none: they are
// exact; they add to the variance of the counts.
std::optional<ChiSquare> chiSquare(std::span<const double> counts, std::span<const double> expectations,
                                   std::span<const double> errors = {});

// Probability that a chi-square variable of so many degrees of freedom is x or more.
double chiSquareTail(double x, double degrees);

} // namespace rt::probe
