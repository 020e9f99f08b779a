// What a film says about its own error.
#pragma once
#include <array>
#include <optional>

#include "Common/Image/Film.h"

namespace rt::app {

// Without second moments or replicates, and with no more than one block of samples, nothing is known of the error.
struct FilmEstimate {
    std::array<double, 3> meanRadiance{};
    std::optional<std::array<double, 3>> standardError; // of meanRadiance
    std::optional<double> relmse;                       // estimatedRelMse() of Metrics.h
};
// Whether a variance can be told: it needs two replicates with samples, or two blocks of one.
bool hasVariance(const image::Film& film);

FilmEstimate estimate(const image::Film& film);

} // namespace rt::app
