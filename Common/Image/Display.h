// What a screen or a PNG file shows of an image.
#pragma once
#include "Common/Image/Image.h"
#include "Common/Image/ImageRows.h"

namespace rt::image {

// Exposure (in stops) and tone curve (shared::kTonemap...) applied to every pixel: linear display intensities in [0,1],
// as writeImage expects for .png. An image of one channel is shown in grey. Its
// rows share a buffer: one thread at a time may ask for them.
ImageRows toDisplay(const ImageRows& radiance, float exposure, std::uint32_t curve);

// Stops that bring the mean logarithm of the luminance to middle grey (Reinhard et al. 2002, "Photographic Tone
// Reproduction for Digital Images", eq. 1 and 2). Black counts for nothing, and neither does the darkest tenth nor
// the brightest twentieth of the rest: a lamp or a shadow more does not change it. 0 for an image of nothing else.
float autoExposure(const Image& radiance);

} // namespace rt::image
