// What the denoiser hands to its kernel, which is compiled for several instruction sets: only plain data crosses.
#pragma once
#include <cstddef>
#include <cstdint>

#include "Common/Shared/Denoise/DenoiseFit.h"
#include "Common/Shared/Denoise/DenoiseWeights.h"

namespace rt::image {

using shared::kDenoiseSurfaceFeatures, shared::kDenoiseTile;
inline constexpr int kDenoiseMargin = shared::kDenoiseReach + shared::kDenoisePatchReach; // around a tile
inline constexpr int kDenoiseRows = kDenoiseTile + 2 * kDenoiseMargin;                    // of a plane
inline constexpr int kDenoisePitch = kDenoiseRows + 10;                                   // floats a row
inline constexpr int kDenoisePlane = kDenoiseRows * kDenoisePitch;                        // floats
inline constexpr int kDenoiseOrigin = kDenoiseMargin * kDenoisePitch + kDenoiseMargin;    // tile's first pixel
inline constexpr int kDenoiseOffsets = (2 * shared::kDenoiseReach + 1) * (2 * shared::kDenoiseReach + 1);
static_assert(kDenoisePitch % 8 == 0);

// One tile of one half. A plane has kDenoisePlane values: the tile with its margin, row by row, and eight floats more
// may be read beyond its end.
struct DenoiseTile {
    int rows = 0, columns = 0;       // of pixels to filter, at most kDenoiseTile each
    const float* guide[3] = {};      // of the other half (DenoiseGuide.h); anything outside of the image
    const float* variance = nullptr; // of these, summed over the channels
    const float* inside = nullptr;   // 1 inside of the image, 0 elsewhere
    // What radiance is taken for a linear function of, besides coordinates: features of the surface; 0 outside of the
    // image.
    int featureCount = 0;
    const float* features[kDenoiseSurfaceFeatures] = {};
    const float* radiance[3] = {};                       // of this half; 0 outside of the image
    float* filtered[shared::kDenoiseBandwidths][3] = {}; // kDenoiseTile x kDenoiseTile each
    // By which a pixel's own radiance enters what is fitted there, and the sum of those of the others in its square of
    // 2x2 where their noise may be like its own. The same size.
    float* ownFactor[shared::kDenoiseBandwidths] = {};
    float* partnerFactor[shared::kDenoiseBandwidths] = {};
    std::uint32_t dependentSide = 1; // 2: the noise of pixels of such a square may be alike
    float* scratch = nullptr;        // kDenoiseScratch values
};

// Distances of the rows that the patches of two rows need, a ring per offset; mean distances of these patches for both
// patch sizes; weights of eight pixels.
inline constexpr int kDenoiseRing = 2 * shared::kDenoisePatchReach + 2;                     // rows
inline constexpr int kDenoiseDistances = kDenoiseTile + 2 * shared::kDenoisePatchReach + 2; // columns
inline constexpr std::size_t kDenoiseScratch =
    std::size_t{kDenoiseOffsets} * (kDenoiseRing * kDenoiseDistances + 2 * 2 * kDenoiseTile + 8);
static_assert(kDenoiseDistances % 8 == 0);

// One row of a half whose guide is made. Pointers are to its first pixel; those that are read are into planes that have
// kDenoiseGuideBorder pixels of zeros around the image, and kDenoiseGuideOverrun floats behind each row may be read.
inline constexpr int kDenoiseGuideOverrun = 64;
struct DenoiseGuideRow {
    int width = 0;
    int pitch = 0; // floats from one row of a plane that is read to the next
    const float *tones[3] = {}, *variance = nullptr, *inside = nullptr; // as DenoiseTile's, before
    float *guide[3] = {}, *guideVariance = nullptr;                     // and afterwards
};

struct DenoiseKernels {
    void (*filterTile)(const DenoiseTile&);
    void (*smoothGuideRow)(const DenoiseGuideRow&);
};

// Of each instruction set; only those of the architecture at hand exist.
DenoiseKernels denoiseKernels_x86_64_v2();
DenoiseKernels denoiseKernels_x86_64_v3();
DenoiseKernels denoiseKernels_x86_64_v4();
DenoiseKernels denoiseKernels_generic();

} // namespace rt::image
