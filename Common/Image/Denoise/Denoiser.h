// A picture with less noise, and what is known of the error that it still has: docs/denoising.md.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "Common/Image/ErrorEstimate.h"
#include "Common/Image/Image.h"
#include "Common/Shared/Denoise/DenoiseWeights.h"

namespace rt::image {

// All of one size. Values that are not finite count as 0.
struct DenoiseInput {
    Image halfA, halfB;              // radiance by two independent halves of the samples
    std::uint64_t samplesOfHalf = 0; // of a pixel, at least
    // Of the surface in sight, averaged over some samples of each pixel; without pixels where they are not known.
    Image albedo, normal, depth;
};

// Candidates of each pixel: denoiseBandwidth(i), and after these the pixel as it is.
inline constexpr std::size_t kDenoiseCandidates = shared::kDenoiseBandwidths + 1;

struct Denoised {
    Image picture; // the mean of both filtered halves
    // Details, without pixels where they are not wanted:
    Image halfA, halfB; // filtered, each by weights from the other
    Image error;        // estimated squared error of `picture`, averaged over some pixels
    Image bandwidth;    // one channel: the candidate that was chosen; between two where pixels around chose differently
    std::array<double, kDenoiseCandidates> shares{}; // of the picture, by candidate
    RelMseEstimate relmse;                           // of `picture`
};

// Over all values of a picture, relative: their squared errors, the least that these can be, and the squares of what
// each pixel adds to the first.
struct DenoiseErrorSums {
    double errors = 0, minimum = 0, squares = 0;
    DenoiseErrorSums& operator+=(const DenoiseErrorSums& other) {
        errors += other.errors;
        minimum += other.minimum;
        squares += other.squares;
        return *this;
    }
};
RelMseEstimate denoisedRelMse(const DenoiseErrorSums& sums, std::uint64_t pixels, std::uint32_t dependentSide);

// The noise of pixels of a square of `dependentSide` may be alike, as in ErrorEstimate.h. The same bits for any number
// of threads (0: as many as the machine has). Whoever may call this thread's work off (Interruption.h) interrupts it.
Denoised denoise(const DenoiseInput& input, std::uint32_t dependentSide, std::size_t threads = 0, bool details = true);

} // namespace rt::image
