// The filters of all bandwidths on both halves of a picture: what Denoiser.h chooses from.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "Common/Image/Denoise/Denoiser.h"
#include "Common/Image/Denoise/Planes.h"
#include "Common/Shared/Denoise/DenoiseChoice.h"
#include "Common/Shared/Denoise/DenoiseFit.h"
#include "Common/Shared/Denoise/DenoiseGuide.h"
#include "Common/Shared/Denoise/DenoiseMix.h"
#include "Common/Shared/Denoise/DenoiseWeights.h"

namespace rt::image {

// A half as the filter reads it.
struct Half {
    Planes radiance, tones;
    Planes guide; // what pixels of the other half are compared by, unless by tones as they are
    Plane guideVariance;
};

struct Halves {
    Half half[2];
    Plane variance; // of a tone of either half, averaged over pixels around and summed over the channels
    std::array<Planes, 2> filtered[shared::kDenoiseBandwidths]; // by each candidate
    // DenoisedValue's factors of each candidate.
    std::array<Plane, 2> ownFactors[shared::kDenoiseBandwidths], partnerFactors[shared::kDenoiseBandwidths];
    // denoiseLikeness() of each pixel and the one that is 1, 2, 3 to the right of it, or below.
    std::array<Plane, shared::kDenoiseChoiceReach> likeAcross, likeDown;
    std::uint32_t dependentSide = 1;
    std::uint64_t samplesOfHalf = 0; // of a pixel

    // With fewer samples too many pixels look free of noise.
    bool mayStayRaw() const { return samplesOfHalf >= shared::kDenoiseRawSamples; }
    bool hasRawGuides() const { return samplesOfHalf >= shared::kDenoiseRawGuideSamples; }
    bool isGivenBack() const { return samplesOfHalf >= shared::kDenoiseCoarseSamples; }
    bool isMixed() const { return samplesOfHalf >= shared::kDenoiseMixSamples; }
};

// What nearly all pixels that see something are nearer than; 1 where there are none.
float usualDepth(const Image& depth);
// The number of that one among `seen` depths in order.
std::size_t usualRank(std::size_t seen);

// Fills what is filtered, the factors, and which pixels are alike; guides are made for that, and given up.
void filterHalves(Halves& halves, const DenoiseInput& input, std::size_t threads);

} // namespace rt::image
