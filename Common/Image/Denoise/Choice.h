// Which filter each pixel takes: DenoiseChoice.h.
#pragma once
#include <cstddef>

#include "Common/Image/Denoise/Blended.h"
#include "Common/Image/Denoise/DenoiseFilter.h"

namespace rt::image {

CandidateWeights choose(const Halves& halves, std::size_t threads);

} // namespace rt::image
