#include "Common/Image/Denoise/Blended.h"

#include <utility>

namespace rt::image {
namespace {

void addWeighed(const float* weights, const float* values, std::size_t width, float* __restrict sums) {
    for (std::size_t x = 0; x < width; ++x) sums[x] += weights[x] * values[x];
}

} // namespace

BlendedRow::BlendedRow(const Halves& halves, const CandidateWeights& weights, std::size_t y)
    : halves_(halves), weights_(weights), y_(y), width_(halves.variance.width()) {
    for (std::size_t half = 0; half < 2; ++half) {
        Values& values = values_[half];
        values.ownFactors.assign(width_, 0.0f);
        values.partnerFactors.assign(width_, 0.0f);
        for (std::size_t i = 0; i < kRawCandidate; ++i) {
            addWeighed(weights[i].row(y), halves.ownFactors[i][half].row(y), width_, values.ownFactors.data());
            addWeighed(weights[i].row(y), halves.partnerFactors[i][half].row(y), width_, values.partnerFactors.data());
        }
        addShifted(weights[kRawCandidate].row(y), 0, width_, values.ownFactors.data()); // rawValue()
    }
}

void BlendedRow::blend(std::size_t channel) {
    channel_ = channel;
    for (std::size_t half = 0; half < 2; ++half) {
        Values& values = values_[half];
        values.raw = halves_.half[half].radiance[channel].row(y_);
        values.filtered.assign(width_, 0.0f);
        for (std::size_t i = 0; i < kRawCandidate; ++i)
            addWeighed(weights_[i].row(y_), halves_.filtered[i][half][channel].row(y_), width_, values.filtered.data());
        addWeighed(weights_[kRawCandidate].row(y_), values.raw, width_, values.filtered.data());
    }
}

float BlendedRow::partnerNoise(std::size_t x) const {
    if (halves_.dependentSide == 1) return 0;
    float sum = 0;
    int count = 0;
    for (const auto& [px, py] : {std::pair{x ^ 1, y_}, std::pair{x, y_ ^ 1}, std::pair{x ^ 1, y_ ^ 1}}) {
        if (px >= width_ || py >= halves_.variance.height()) continue;
        sum += halves_.half[0].radiance[channel_].row(py)[px] - halves_.half[1].radiance[channel_].row(py)[px];
        ++count;
    }
    return count > 0 ? sum / static_cast<float>(count) : 0;
}

Blended BlendedRow::at(std::size_t x) const {
    Blended result;
    result.a = values_[0].at(x);
    result.b = values_[1].at(x);
    const float difference = result.a.filtered - result.b.filtered;
    result.mean = 0.5f * (result.a.filtered + result.b.filtered);
    result.noise = 0.25f * difference * difference;
    result.error = shared::denoiseError(result.a, result.b, partnerNoise(x)) - result.noise;
    return result;
}

} // namespace rt::image
