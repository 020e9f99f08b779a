#include "Common/Image/Denoise/Blended.h"

#include <utility>

namespace rt::image {
namespace {

// A pixel's value by all candidates.
shared::DenoisedValue blended(const Halves& halves, const Choice& weights, std::size_t half, std::size_t channel,
                              std::size_t x, std::size_t y) {
    shared::DenoisedValue sum{0, halves.half[half].radiance[channel].row(y)[x], 0, 0};
    for (std::size_t i = 0; i < kDenoiseCandidates; ++i) {
        const float weight = weights[i].row(y)[x];
        const shared::DenoisedValue value = valueOf(halves, i, half, channel, x, y);
        sum.filtered += weight * value.filtered;
        sum.ownFactor += weight * value.ownFactor;
        sum.partnerFactor += weight * value.partnerFactor;
    }
    return sum;
}

// The mean difference of the raw halves of those pixels of a 2x2 square that are not the one at hand.
float partnerNoise(const Halves& halves, std::size_t channel, std::size_t x, std::size_t y) {
    if (halves.dependentSide == 1) return 0;
    float sum = 0;
    int count = 0;
    for (const auto& [px, py] : {std::pair{x ^ 1, y}, std::pair{x, y ^ 1}, std::pair{x ^ 1, y ^ 1}}) {
        if (px >= halves.variance.width() || py >= halves.variance.height()) continue;
        sum += halves.half[0].radiance[channel].row(py)[px] - halves.half[1].radiance[channel].row(py)[px];
        ++count;
    }
    return count > 0 ? sum / static_cast<float>(count) : 0;
}

} // namespace

shared::DenoisedValue valueOf(const Halves& halves, std::size_t candidate, std::size_t half, std::size_t channel,
                              std::size_t x, std::size_t y) {
    const float raw = halves.half[half].radiance[channel].row(y)[x];
    if (candidate == kRawCandidate) return rawValue(raw);
    return {halves.filtered[candidate][half][channel].row(y)[x], raw, halves.ownFactors[candidate][half].row(y)[x],
            halves.partnerFactors[candidate][half].row(y)[x]};
}

Blended blendedAt(const Halves& halves, const Choice& weights, std::size_t channel, std::size_t x, std::size_t y) {
    Blended result;
    result.a = blended(halves, weights, 0, channel, x, y);
    result.b = blended(halves, weights, 1, channel, x, y);
    const float difference = result.a.filtered - result.b.filtered;
    result.mean = 0.5f * (result.a.filtered + result.b.filtered);
    result.noise = 0.25f * difference * difference;
    result.error = shared::denoiseError(result.a, result.b, partnerNoise(halves, channel, x, y)) - result.noise;
    return result;
}

} // namespace rt::image
