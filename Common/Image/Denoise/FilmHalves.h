// The halves of a film for the denoiser.
#pragma once
#include <cstdint>
#include <string>

#include "Common/Image/Denoise/Denoiser.h"
#include "Common/Image/Film.h"

namespace rt::image {

// Why a film cannot be denoised; empty: it can.
std::string whyNoHalves(const Film& film);

// Its even and its odd replicates; without features. Requires that it has both.
DenoiseInput filmHalves(const Film& film, std::size_t threads = 0);

} // namespace rt::image
