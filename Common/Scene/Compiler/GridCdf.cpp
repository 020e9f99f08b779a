#include "Common/Scene/Compiler/GridCdf.h"

#include <cmath>
#include <cstddef>

namespace rt::scene {

std::vector<float> gridCdf(std::span<const double> weights) {
    double total = 0;
    std::size_t positive = 0;
    for (double weight : weights) {
        total += weight;
        positive += weight > 0;
    }
    std::vector<float> cdf(weights.size() + 1, 0.0f);
    cdf.back() = 1.0f;
    if (positive == 0) return cdf;

    // One cell for each bin that can be chosen, the others by weight.
    const double shared = kCdfCells - static_cast<double>(positive);
    double sum = 0;
    std::size_t seen = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        sum += weights[i];
        seen += weights[i] > 0;
        const double cells =
            seen == positive ? kCdfCells : static_cast<double>(seen) + std::floor(shared * (sum / total));
        cdf[i + 1] = static_cast<float>(cells / kCdfCells);
    }
    return cdf;
}

} // namespace rt::scene
