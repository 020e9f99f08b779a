#include "Common/Probe/DensityTest.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace rt::probe {

bool DensityTest::isResolved() const {
    constexpr double kMostUncertainty = 0.3, kMostErrorOfAll = 0.03;
    return (!cells || cells->uncertainty <= kMostUncertainty) && error <= kMostErrorOfAll;
}

DensityTest testDensity(std::span<const double> counts, double dropped, const DirectionMap& density) {
    const double drawn = std::accumulate(counts.begin(), counts.end(), dropped);
    const double lack = std::max(1 - density.integral(), 0.0), error = density.integralError();
    const double solidAngle = density.cellSolidAngle();
    std::vector<double> all(counts.begin(), counts.end()), expected, errors;
    all.push_back(dropped);
    for (const float value : density.values) expected.push_back(value * solidAngle);
    expected.push_back(lack);
    for (const float each : density.errors) errors.push_back(each * solidAngle);
    if (!errors.empty()) errors.push_back(error);
    DensityTest test;
    test.error = error;
    test.cells = chiSquare(all, expected, errors);

    // By the greater of what is dropped and what should be: either may be 0.
    const double share = std::clamp(std::max(lack, dropped / drawn), 0.0, 1.0);
    const double variance = std::max(drawn * share * (1 - share), 1.0) + drawn * error * drawn * error;
    const double difference = dropped - drawn * (1 - density.integral());
    test.total = chiSquareTail(difference * difference / variance, 1);
    return test;
}

} // namespace rt::probe
