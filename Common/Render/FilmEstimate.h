// What a film says about its own error.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "Common/Image/ErrorEstimate.h"
#include "Common/Image/Film.h"

namespace rt::app {

// Without second moments or replicates, and with no more than one block of samples, nothing is known of the error.
struct FilmEstimate {
    std::array<double, 3> meanRadiance{};
    std::optional<std::array<double, 3>> standardError; // of meanRadiance
    std::optional<image::RelMseEstimate> relmse;
};
// Whether a variance can be told: it needs samples in two replicates or more, and then in each, or two blocks of one.
bool hasVariance(const image::Film& film);

// Both take a few rows of memory, however large the image is. The noise of pixels of a square of `dependentSide` may
// be alike: standard errors are then upper bounds.
std::optional<image::RelMseEstimate> estimateRelMse(const image::Film& film, std::uint32_t dependentSide);
FilmEstimate estimate(const image::Film& film, std::uint32_t dependentSide);

} // namespace rt::app
