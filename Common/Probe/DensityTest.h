// Do samples follow a density?
#pragma once
#include <optional>
#include <span>

#include "Common/Probe/ChiSquare.h"
#include "Common/Probe/DirectionMap.h"

namespace rt::probe {

struct DensityTest {
    static constexpr double kSuspicious = 0.001; // of p: something is wrong

    std::optional<ChiSquare> cells; // over the map's cells, and what is dropped
    double total = 1;               // p of integral and share that is dropped, which make 1
    double error = 0;               // of the integral
    // Whether the integrals over cells are known well enough for so many samples: if not, a small p says nothing.
    bool isResolved() const;
};

// `counts`: of samples in the cells of the density's map, which has all directions. Errors of the map's integrals are a
// part of the variance. No chi-square where too little is counted.
DensityTest testDensity(std::span<const double> counts, double dropped, const DirectionMap& density);

} // namespace rt::probe
