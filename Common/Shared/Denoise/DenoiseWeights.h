// How alike two pixels are for the denoiser, by what one half of a picture's samples says of them and how noisy it is.
// After Rousselle et al. 2012, "Adaptive Rendering with Non-Local Means Filtering": the squared difference of two
// patches, less what noise alone makes of it, in units of that noise. The weights are used on the other half, whose
// noise had no say in them. See docs/denoising.md.
#ifndef RT_SHARED_DENOISE_WEIGHTS_H
#define RT_SHARED_DENOISE_WEIGHTS_H
#include "Common/Shared/Base/Elementary.h"
#include "Common/Shared/Base/Shim.h"

RT_SHARED_BEGIN

const int kDenoiseReach = 8;         // pixels from the one that is filtered, in either direction
const int kDenoisePatchReach = 3;    // of the larger patch, 7x7
const int kDenoiseVarianceReach = 3; // over so many pixels around it a pixel's variance is averaged
const int kDenoiseErrorReach = 2;    // the same for the error that is left
const float kDenoiseMaxRadiance = 1.0e15f;

// One of the filters among which each pixel chooses.
struct DenoiseBandwidth {
    int patchReach;  // pixels; at most kDenoisePatchReach
    float bandwidth; // in standard deviations of the difference of two pixels: the larger, the smoother
};
const uint kDenoiseBandwidths = 3u;

RT_FN DenoiseBandwidth denoiseBandwidth(uint candidate) {
    DenoiseBandwidth result;
    result.patchReach = candidate == 0u ? 1 : kDenoisePatchReach;
    result.bandwidth = candidate == 0u ? 1.25f : candidate == 1u ? 0.35f : 0.7f;
    return result;
}

RT_FN float denoisePerSquaredBandwidth(uint candidate) {
    float bandwidth = denoiseBandwidth(candidate).bandwidth;
    return 1.0f / (bandwidth * bandwidth);
}

// A pixel's radiance as it is filtered.
RT_FN float denoiseRadiance(float radiance) {
    return isFinite(radiance) ? min(radiance, kDenoiseMaxRadiance) : 0.0f;
}

// The tone in which pixels are compared: in linear radiance the brightest ones alone would count.
RT_FN float denoiseTone(float radiance) {
    return log1p(4.0f * clamp(radiance, 0.0f, kDenoiseMaxRadiance));
}

// Of two pixels a and b by a half's tones and their variances, each summed over the channels. Its expectation is 0 where
// both converge to the same. The variance of b counts as far as that of a goes: a noisy pixel is like none just because
// it may be anything.
RT_FN float denoiseDistance(float squaredDifference, float varianceA, float varianceB) {
    const float kMinVariance = 0.012f; // a difference of 0.06 in each channel is none
    float noise = varianceA + min(varianceA, varianceB);
    return (squaredDifference - noise) / (kMinVariance + varianceA + varianceB);
}

// exp(-distance / bandwidth^2) but for a tail that ends, for the mean distance of two patches.
RT_FN float denoiseWeight(float distance, float perSquaredBandwidth) {
    float x = clamp(1.0f - 0.125f * perSquaredBandwidth * distance, 0.0f, 1.0f);
    float x2 = x * x;
    float x4 = x2 * x2;
    return x4 * x4;
}

// A filtered half of one channel, and what it was made of. It is linear in the raw half, as the weights come from the
// other one.
struct DenoisedValue {
    float filtered;
    float raw;
    float ownFactor;     // by which `raw` enters `filtered`
    float partnerFactor; // and the pixels whose noise may be like this one's
};

// Squared error of filtered halves of one pixel, averaged over both: how far each is from its raw half, less that one's
// noise but for what the filter lets through of it (Stein 1981, "Estimation of the Mean of a Multivariate Normal
// Distribution"). The expectation is right, but one value may be negative. `partnerNoise`: the mean difference of raw
// halves of the pixels whose noise may be like this one's.
RT_FN float denoiseError(DenoisedValue a, DenoisedValue b, float partnerNoise) {
    float changeA = a.filtered - a.raw;
    float changeB = b.filtered - b.raw;
    float noise = a.raw - b.raw;
    float through = (a.ownFactor + b.ownFactor - 1.0f) * noise + (a.partnerFactor + b.partnerFactor) * partnerNoise;
    return 0.5f * (changeA * changeA + changeB * changeB + through * noise);
}

RT_SHARED_END

#endif
