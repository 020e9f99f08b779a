// What the filters of all bandwidths make of a row of pixels together.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "Common/Image/Denoise/DenoiseFilter.h"
#include "Common/Image/Denoise/Planes.h"
#include "Common/Shared/Denoise/DenoiseWeights.h"

namespace rt::image {

inline constexpr std::size_t kRawCandidate = shared::kDenoiseBandwidths; // leaves a pixel as it is

using CandidateWeights = std::array<Plane, kDenoiseCandidates>; // of each in a pixel; their sum is 1

// A pixel of a half as it is.
inline shared::DenoisedValue rawValue(float raw) {
    return {raw, raw, 1, 0};
}

// Of one channel of a pixel, in radiance.
struct Blended {
    shared::DenoisedValue a, b; // both halves
    float mean;                 // of them
    float noise;                // of the mean: half of theirs, squared
    float error;                // of the mean, squared, as estimated
};

// A row of pixels, of which one channel at a time is blended. Halves and weights must outlive it.
class BlendedRow {
  public:
    BlendedRow(const Halves& halves, const CandidateWeights& weights, std::size_t y);

    void blend(std::size_t channel);
    Blended at(std::size_t x) const; // of that channel

  private:
    // Of one half.
    struct Values {
        const float* raw = nullptr;
        std::vector<float> filtered, ownFactors, partnerFactors;
        shared::DenoisedValue at(std::size_t x) const {
            return {filtered[x], raw[x], ownFactors[x], partnerFactors[x]};
        }
    };

    // The mean difference of the raw halves of those pixels of a 2x2 square that are not the one at hand.
    float partnerNoise(std::size_t x) const;

    const Halves& halves_;
    const CandidateWeights& weights_;
    std::size_t y_, width_, channel_ = 0;
    Values values_[2];
};

} // namespace rt::image
