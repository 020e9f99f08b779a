// What the denoiser's passes hand to each other, valid as C++20 and as GLSL: where pixels stand in its planes, and the
// push constants of all passes. See docs/denoising.md.
#ifndef RT_SHADERS_DENOISE_RECORDS_H
#define RT_SHADERS_DENOISE_RECORDS_H
#include "Common/Shared/Denoise/DenoiseChoice.h"
#include "Common/Shared/Denoise/DenoiseFit.h"
#include "Common/Shared/Denoise/DenoiseGuide.h"
#include "Common/Shared/Denoise/DenoiseHistory.h"
#include "Common/Shared/Denoise/DenoiseMix.h"
#include "Common/Shared/Denoise/DenoiseWeights.h"
#include "Records.h"

RT_SHARED_BEGIN

// Planes of four floats a pixel, each of which is one load.
#ifdef __cplusplus
using PixelPlane = std::uint64_t;
#else
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer PixelPlane {
    vec4 at[];
};
#endif

// Pixels of a work group that filters.
const int kDenoiseColumns = 8;
const int kDenoiseRows = 16;
const int kDenoiseGroupSize = kDenoiseColumns * kDenoiseRows;
// Around the image, bordered planes have what is in reach of the patches of what is in reach: zeros, so that nothing
// has to ask where it is. One more than these reach: so the pitch is a whole number of lines of memory.
const int kDenoiseBorder = kDenoiseReach + kDenoisePatchReach + 1;
const int kDenoiseTileReach = kDenoiseTile + 2 * kDenoiseReach; // pixels a side of what a tile's pixels are fitted by
const uint kDenoiseSums = 8u;                                   // of a work group: see DenoiseBlend.comp

// Of work groups, by level of noise: sums of DenoiseMix.comp and of DenoiseCoarse.comp.
const uint kMixOfFilter = 0u;
const uint kMixOfResidual = 1u;
const uint kDenoiseMixes = 2u;
const uint kDenoiseMixSums = kDenoiseMixes * uint(kDenoiseNoiseLevels) * 2u; // of a work group: gain and change

// What a pass that averages over squares does with the means.
const uint kMeansOfTones = 0u;   // the first component is the variance of a tone of either half,
const uint kMeansToGuides = 1u;  // and of both guides, where tones are guides
const uint kMeansPositive = 2u;  // negative ones become 0
const uint kMeansToTones = 3u;   // the same for the tones of LiveLaunch
const uint kMeansOfHistory = 4u; // as they are, over the pixels that a variance is averaged over

// Push constants of all passes. Halves follow each other in what has both.
struct DenoiseLaunch {
    MutableVectorArray halves;   // radiance as rendered, row by row
    MutableFloatArray surfaces;  // kSurfaceValues of each pixel
    PixelPlane radiance;         // bordered; the last component is 1 in the image
    PixelPlane guides;           // bordered: what pixels are compared by (DenoiseGuide.h), tones and their variance,
                                 // summed over the channels. After the fit, in the first half's place, normals
                                 // and depths, scaled
    PixelPlane features;         // of the surface, of what is in reach of each tile
    MutableWordArray axes;       // how many of these each tile has
    PixelPlane filtered;         // by each candidate: radiance; the two factors, packed. Before that, bordered: the
                                 // tones that guides are made of, and their variance. In the end what has been taken
                                 // away from each half, in the mean of the pixels around
    PixelPlane values;           // what is averaged over squares: variances; errors of the candidates; squared errors.
                                 // Between the last two: the weight of each candidate
    PixelPlane means;            // of these
    MutableVectorArray pictures; // the result, and both halves of it
    MutableFloatArray kept;      // the candidate of each pixel; then the variance of a tone of a half, as averaged
    MutableFloatArray sums;      // kDenoiseSums of each work group; then kDenoiseMixSums of each
    uint width;
    uint height;
    uint candidates;    // among which a pixel may choose
    uint dependentSide; // 2: the noise of pixels of a square of 2x2 may be alike
    float usualDepth;
    uint firstRow; // of work groups, that are filtered
    uint use;      // of means, by flags
    uint mixed;    // 1: with the raw picture
};

// Push constants of the passes of live quality. No plane has a border.
struct LiveLaunch {
    MutableVectorArray halves;  // as DenoiseLaunch's; after the last level the picture
    MutableFloatArray surfaces; // as DenoiseLaunch's
    PixelPlane features;        // of the surface: albedo and depth of all pixels, then normals
    PixelPlane values;          // the variance of a tone by each pixel alone
    // By the weights of each half: the other one's radiance; the half's own tones, and their variance. As the level
    // before has left them, and as this one does.
    PixelPlane radiance;
    PixelPlane tones;
    PixelPlane newRadiance;
    PixelPlane newTones;
    uint width;
    uint height;
    int level;
};

// The cameras of a live picture and of the one before it.
struct HistoryCameras {
    Camera now;
    Camera last;
};
#ifdef __cplusplus
using HistoryCamerasAddress = std::uint64_t;
#else
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer HistoryCamerasAddress {
    HistoryCameras at;
};
#endif

// Planes of what a live picture leaves for the next one: both halves as radiance and number of samples; points, from
// the middle of the lens, with what packHistorySurface() makes of the rest.
const uint kHistoryPlanes = 3u;
const uint kHistoryPoints = 2u;
// Push constants of DenoiseHistory.comp and DenoiseHistoryMerge.comp.
struct HistoryLaunch {
    MutableVectorArray halves;   // as DenoiseLaunch's; where both are one picture, that alone
    MutableFloatArray surfaces;  // as DenoiseLaunch's
    HistoryCamerasAddress views; // of both pictures
    PixelPlane last;             // kHistoryPlanes of the picture before; read where lastWidth is not 0
    PixelPlane next;             // the same of this one
    PixelPlane found;            // both halves of the picture before, where this one's camera sees them
    PixelPlane differences;      // of new samples from these, of each half, and their squares
    PixelPlane means;            // of these
    MutableVectorArray merged;   // both halves, with their history
    uint width;
    uint height;
    uint lastWidth;
    uint lastHeight;
    float samples;       // that a pixel of a half is the mean of, or one of a picture that is one
    uint isOne;          // 1: the picture is one, and each of its pixels belongs to a half,
    uint firstHalfOfOne; // that in the upper left corner to this one
};

// Push constants of DenoiseDepths.comp.
const uint kDepthDigits = 256u;
struct DepthLaunch {
    MutableFloatArray surfaces; // as DenoiseLaunch's
    MutableWordArray counts;    // of each digit, which are added to
    uint pixels;
    uint mask;  // of the bits that are known
    uint known; // which are these
    uint shift; // of the digit
};

// Bordered planes: whole work groups inside of the border.
RT_FN int denoisePitch(uint width) {
    return (int(width) + kDenoiseColumns - 1) / kDenoiseColumns * kDenoiseColumns + 2 * kDenoiseBorder;
}
RT_FN int denoisePlaneRows(uint height) {
    return (int(height) + kDenoiseRows - 1) / kDenoiseRows * kDenoiseRows + 2 * kDenoiseBorder;
}

RT_SHARED_END

#endif
