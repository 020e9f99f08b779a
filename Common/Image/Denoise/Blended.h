// What the filters of all bandwidths make of a pixel together.
#pragma once
#include <array>
#include <cstddef>

#include "Common/Image/Denoise/DenoiseFilter.h"
#include "Common/Image/Denoise/Planes.h"
#include "Common/Shared/Denoise/DenoiseWeights.h"

namespace rt::image {

inline constexpr std::size_t kRawCandidate = shared::kDenoiseBandwidths; // leaves a pixel as it is

using Choice = std::array<Plane, kDenoiseCandidates>; // the weight of each candidate in a pixel

// A pixel of a half as it is.
inline shared::DenoisedValue rawValue(float raw) {
    return {raw, raw, 1, 0};
}
// The value of a candidate in place of a pixel of a half, in radiance.
shared::DenoisedValue valueOf(const Halves& halves, std::size_t candidate, std::size_t half, std::size_t channel,
                              std::size_t x, std::size_t y);

// Of one channel of a pixel.
struct Blended {
    shared::DenoisedValue a, b; // both halves
    float mean;                 // of them
    float noise;                // of the mean: half of theirs, squared
    float error;                // of the mean, squared, as estimated
};
Blended blendedAt(const Halves& halves, const Choice& weights, std::size_t channel, std::size_t x, std::size_t y);

} // namespace rt::image
