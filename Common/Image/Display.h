// What a screen or a PNG file shows of an image.
#pragma once
#include "Common/Image/ImageRows.h"

namespace rt::image {

// Exposure (in stops) and tone curve (shared::kTonemap...) applied to every pixel: linear display intensities in [0,1],
// as writeImage expects for .png. An image of one channel is shown in grey.
ImageRows toDisplay(const ImageRows& radiance, float exposure, std::uint32_t curve);

} // namespace rt::image
