// Discrete distributions that a uniform number of 24 bits draws from exactly.
#pragma once
#include <span>
#include <vector>

namespace rt::scene {

inline constexpr double kCdfCells = 16777216; // 2^24, the grid of uniform numbers

// n + 1 values from 0 to exactly 1, all multiples of 2^-24: bin i is [cdf[i], cdf[i+1]). Its width is its probability
// to the last bit for a u on that grid; it is in proportion to the weight (>= 0) up to the grid, at least 2^-24 where
// the weight is positive, and 0 where it is 0. At most 2^24 weights may be positive. Without any, the last bin gets
// everything.
std::vector<float> gridCdf(std::span<const double> weights);

} // namespace rt::scene
