// How much of the filter a picture keeps: DenoiseMix.h.
#pragma once
#include <cstddef>

#include "Common/Image/Denoise/Blended.h"
#include "Common/Image/Denoise/DenoiseFilter.h"
#include "Common/Image/Denoise/Denoiser.h"

namespace rt::image {

// Gives a part of each pixel back to what it was.
void mixWithRaw(const Halves& halves, CandidateWeights& weights, std::size_t threads);

// Gives back a part of what the filter took away from the pixels around each, in the mean.
void giveBack(const Halves& halves, Denoised& result, std::size_t threads);

} // namespace rt::image
