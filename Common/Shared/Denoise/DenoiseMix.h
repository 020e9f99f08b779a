// How much of the filter a picture keeps. What details a filter spoils hardly depends on the number of samples, while
// noise falls with it: from some number on, a part of the raw picture makes the mean of both better than either.
//
// A picture w filtered + (1 - w) raw is least off for w = (errorOfRaw - errorOfFiltered + change^2) / (2 change^2),
// where errors are expected squared ones and change is filtered - raw, as the expectation of change^2 is the sum of
// both errors less twice what they have in common (Bates and Granger 1969, "The Combination of Forecasts"). Both
// terms are summed over the pixels of a cell, in units of relMSE, since those of a pixel are mostly noise.
#ifndef RT_SHARED_DENOISE_MIX_H
#define RT_SHARED_DENOISE_MIX_H
#include "Common/Shared/Base/Shim.h"

RT_SHARED_BEGIN

const int kDenoiseCell = 16;                  // pixels a side
RT_CONST float kDenoiseRelativeFloor = 0.01f; // of relMSE's denominator
// Of each half, from which on a picture is mixed: with fewer, few bright samples are most of a cell's sums, and what
// they pretend costs more than the details are worth.
const uint kDenoiseMixSamples = 32u;

// Numerator and denominator of w.
struct DenoiseMix {
    float gain;
    float change;
};

// Of one channel of a pixel. `raw` and `filtered`: halves of it. `error`: squared, of the mean of the filtered ones.
RT_FN DenoiseMix denoiseMix(float rawA, float rawB, float filteredA, float filteredB, float error) {
    float filtered = 0.5f * (filteredA + filteredB);
    float change = filtered - 0.5f * (rawA + rawB);
    float noise = 0.5f * (rawA - rawB); // whose square is the error of the mean of the raw halves
    float unit = 1.0f / (filtered * filtered + kDenoiseRelativeFloor);
    DenoiseMix mix;
    mix.gain = 0.5f * unit * (noise * noise - error + change * change);
    mix.change = unit * change * change;
    return mix;
}

// w. Where the filter has changed nothing, all is kept.
RT_FN float denoiseFilterShare(DenoiseMix mix) {
    return mix.change > 0.0f ? clamp(mix.gain / mix.change, 0.0f, 1.0f) : 1.0f;
}

// Along one axis: the cell whose middle is the last one before a pixel's, and how far the pixel is on its way to the
// next one. Sums are interpolated, so that no seam is seen. The cell may be one outside of the image.
struct DenoiseCellPlace {
    int first;
    float fraction;
};
RT_FN DenoiseCellPlace denoiseCellPlace(int pixel) {
    float place = (float(pixel) + 0.5f) / float(kDenoiseCell) - 0.5f;
    DenoiseCellPlace result;
    result.first = int(floor(place));
    result.fraction = place - floor(place);
    return result;
}

RT_SHARED_END

#endif
