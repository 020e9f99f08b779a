// Integrals of densities over cells against those that are known: a thin strip, and one without a bound at its edge.
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Probe/CellIntegrals.h"

namespace rt::probe {
namespace {

constexpr std::uint32_t kCellSide = 8; // cells along a map of solid angle 1

struct SumOfCells {
    double integral = 0, error = 0;
};

// Guides: places that the samples of the density have, each of `drawn`.
SumOfCells sumOfCells(const CellIntegrals::Density& density, const std::vector<glm::dvec2>& places) {
    std::vector<std::size_t> cells(std::size_t{kCellSide} * kCellSide);
    std::iota(cells.begin(), cells.end(), std::size_t{0});
    std::vector<Guide> guides;
    guides.reserve(places.size());
    for (const glm::dvec2& place : places) guides.push_back({place, density(place)});
    const double solidAngle = 1.0 / static_cast<double>(cells.size());
    CellIntegrals integrals(density, {kCellSide, kCellSide, solidAngle, 4096, 3}, cells, guides,
                            static_cast<double>(places.size()));
    while (!integrals.isDone()) integrals.advance();
    SumOfCells all;
    for (const CellIntegrals::Mean& mean : integrals.means()) {
        all.integral += mean.value * solidAngle;
        all.error = std::hypot(all.error, mean.error * solidAngle);
    }
    return all;
}

// Across the map, at a slant, of a hundredth of a cell's width; samples are spread evenly over it.
TEST(CellIntegrals, AThinStripIsFound) {
    constexpr double kWidth = 0.01 / kCellSide;
    const auto density = [](const glm::dvec2& place) {
        return std::abs(place.y - 0.3 - 0.4 * place.x) < kWidth / 2 ? 1 / kWidth : 0.0;
    };
    std::vector<glm::dvec2> places;
    for (int i = 0; i < 4096; ++i) {
        const double x = (i + 0.5) / 4096, across = std::fmod(i * 0.618034, 1.0) - 0.5;
        places.emplace_back(x, 0.3 + 0.4 * x + 0.99 * kWidth * across);
    }
    const SumOfCells found = sumOfCells(density, places);
    EXPECT_LT(found.error, 0.01);
    EXPECT_NEAR(found.integral, 1, 4.5 * found.error);
}

TEST(CellIntegrals, AnEdgeWithoutABoundIsKnownToItsError) {
    constexpr double kEdge = 0.37;
    const auto density = [](const glm::dvec2& place) {
        const double inside = (place.x - kEdge) / (1 - kEdge);
        return inside > 0 ? 0.5 / std::sqrt(inside) / (1 - kEdge) : 0.0;
    };
    std::vector<glm::dvec2> places;
    for (int i = 0; i < 4096; ++i) {
        const double u = std::fmod(i * 0.618034, 1.0);
        places.emplace_back(kEdge + (1 - kEdge) * u * u, (i + 0.5) / 4096);
    }
    const SumOfCells found = sumOfCells(density, places);
    EXPECT_LT(found.error, 0.005);
    EXPECT_NEAR(found.integral, 1, 4.5 * found.error);
}

} // namespace
} // namespace rt::probe
