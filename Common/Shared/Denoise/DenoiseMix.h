// How much of the filter a picture keeps. What details a filter spoils hardly depends on the number of samples, while
// noise falls with it: from some number on, a part of the raw picture makes the mean of both better than either.
//
// A picture w filtered + (1 - w) raw is least off for w = (errorOfRaw - errorOfFiltered + change^2) / (2 change^2),
// where errors are expected squared ones and change is filtered - raw, as the expectation of change^2 is the sum of
// both errors less twice what they have in common (Bates and Granger 1969, "The Combination of Forecasts"). Both
// terms are summed over the pixels of a cell, in units of relMSE, since those of a pixel are mostly noise. In a cell
// each level of noise has sums of its own: where a quiet surface meets an edge or a lamp, the raw picture may be right
// for one and wrong for the other.
#ifndef RT_SHARED_DENOISE_MIX_H
#define RT_SHARED_DENOISE_MIX_H
#include "Common/Shared/Denoise/DenoiseWeights.h"

RT_SHARED_BEGIN

const int kDenoiseCell = 32;                  // pixels a side
RT_CONST float kDenoiseRelativeFloor = 0.01f; // of relMSE's denominator
// Of each half, from which on a picture is mixed: with fewer, a cell's sums are mostly noise, which costs more than the
// details are worth.
const uint kDenoiseMixSamples = 16u;
const int kDenoiseNoiseLevels = 8; // from one to the next noise is twice as much

// What is left to mix then is coarser than a pixel. Where a filter blurs an edge or a highlight, it takes away about
// the same from all pixels around, while their noise differs: the mean over some pixels of raw - filtered has most of
// the one and little of the other, and shows the filter's error where single pixels do not. A part of that mean is
// given back to each pixel.
const int kDenoiseCoarseReach = 2;     // pixels in either direction, over which the mean is taken
const uint kDenoiseCoarseSamples = 4u; // of each half, from which on it is done

// Numerator and denominator of a part that is kept or given back.
struct DenoiseMix {
    float gain;
    float change;
};

// What is to be added to denoiseError() of one pixel where one half alone has met something bright. By that half no
// other pixel is like this one, so that the other half stays as it is: its factor is nearly 1, though it has no noise.
// With the mean of both factors most of the bright half's noise counts as let through, and what the filter took away as
// its error. So each factor counts as far as its half was changed. Over whole pictures denoiseError() is nearer to the
// truth.
RT_FN float denoiseMixCorrection(DenoisedValue a, DenoisedValue b) {
    float changeA = (a.filtered - a.raw) * (a.filtered - a.raw);
    float changeB = (b.filtered - b.raw) * (b.filtered - b.raw);
    float noise = (a.raw - b.raw) * (a.raw - b.raw);
    if (changeA + changeB <= 0.0f) return 0.0f;
    return 0.5f * (a.ownFactor - b.ownFactor) * ((changeA - changeB) / (changeA + changeB)) * noise;
}

// Of one channel of a pixel, by its halves. `error`: squared, of the mean of the filtered ones.
RT_FN DenoiseMix denoiseMix(DenoisedValue a, DenoisedValue b, float error) {
    float filtered = 0.5f * (a.filtered + b.filtered);
    float change = filtered - 0.5f * (a.raw + b.raw);
    float noise = 0.5f * (a.raw - b.raw); // whose square is the error of the mean of the raw halves
    float unit = 1.0f / (filtered * filtered + kDenoiseRelativeFloor);
    DenoiseMix mix;
    mix.gain = 0.5f * unit * (noise * noise - error - denoiseMixCorrection(a, b) + change * change);
    mix.change = unit * change * change;
    return mix;
}

// Of one channel of a pixel, by means over the pixels around: of what the filter took away from each half, and of half
// of the difference of the raw halves. The part v of the mean r of both residuals that makes the error least is 1 less
// the share of r's square that is noise: the noise of r times the noise of the raw mean, for which half of both halves'
// difference stands (James and Stein 1961, "Estimation with Quadratic Loss", with the noise measured).
RT_FN DenoiseMix denoiseCoarseMix(float residualA, float residualB, float halfDifference, float filtered) {
    float residual = 0.5f * (residualA + residualB);
    float noise = halfDifference * (0.5f * (residualA - residualB));
    float unit = 1.0f / (filtered * filtered + kDenoiseRelativeFloor);
    DenoiseMix mix;
    mix.gain = unit * (residual * residual - noise);
    mix.change = unit * residual * residual;
    return mix;
}

RT_FN float denoiseGivenBack(float filtered, float residual) {
    return max(filtered + residual, 0.0f);
}

// Among kDenoiseNoiseLevels, by the variance of a tone of a half, summed over the channels and averaged over pixels
// around; between two of them for most.
RT_FN float denoiseNoiseLevel(float variance) {
    const float kLowest = 1.0e-6f;
    const float kPerLogarithm = 0.72134752f; // 1 / log(4)
    return clamp(kPerLogarithm * logarithm(max(variance, kLowest) / kLowest), 0.0f, float(kDenoiseNoiseLevels - 1));
}

// The part of a pixel that counts for a level.
RT_FN float denoisePartOfLevel(float noiseLevel, int level) {
    return max(1.0f - abs(noiseLevel - float(level)), 0.0f);
}

// w, or v. Where the filter has changed nothing, all is kept.
RT_FN float denoiseMixShare(DenoiseMix mix) {
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
