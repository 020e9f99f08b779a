// FLIP: how different two images look to someone who flips between them. Andersson, Nilsson, Akenine-Möller, Oskarsson,
// Åström, Fairchild: "FLIP: A Difference Evaluator for Alternating Images", PACMCGIT 3(2), 2020. Written from the
// paper.
#pragma once
#include "Common/Image/Image.h"

namespace rt::image {

// A monitor of 3840 pixels on 0.7 m, seen from 0.7 m: the paper's default.
inline constexpr double kFlipPixelsPerDegree = 67.0206432766;

// Per pixel in [0,1], one channel. Both images are linear radiance, one channel is grey; as on a screen, values are
// clamped to [0,1]. Throws InputError unless both have the same size and are finite.
Image flipMap(const Image& image, const Image& reference, double pixelsPerDegree = kFlipPixelsPerDegree);

// The mean of flipMap: 0 for images that look the same, at most 1.
double flip(const Image& image, const Image& reference, double pixelsPerDegree = kFlipPixelsPerDegree);

} // namespace rt::image
