// What pixels are compared by: a half's tones, less noisy by a first, small filter. Differences that the noise of single
// pixels hides are seen then. Each half is filtered by its own weights alone, so that the other half's noise still has
// no say in what that one is filtered by (Bitterli et al. 2016, section 4.3, filter features in advance the same way).
#ifndef RT_SHARED_DENOISE_GUIDE_H
#define RT_SHARED_DENOISE_GUIDE_H
#include "Common/Shared/Denoise/DenoiseWeights.h"

RT_SHARED_BEGIN

const int kDenoiseGuideReach = 2;      // pixels from the one that is filtered, in either direction
const int kDenoiseGuidePatchReach = 1; // of the patches that are compared, 3x3
const int kDenoiseGuideBorder = kDenoiseGuideReach + kDenoiseGuidePatchReach;
// With so many samples of a half pixels are compared by their tones as they are: what the filter blurs of gradients is
// worse then than noise.
const uint kDenoiseRawGuideSamples = 32u;
const float kDenoiseGuideShare = 0.8f; // of the filtered tone; the rest is the pixel's own, which keeps gradients

// Of a pixel, by the mean distance of the patches around both.
RT_FN float denoiseGuideWeight(float distance) {
    return denoiseWeight(distance, 1.0f);
}

RT_FN float denoiseGuideTone(float tone, float filtered) {
    return tone + kDenoiseGuideShare * (filtered - tone);
}

// Variance of the guide over that of a tone, from the sums of the weights and of their squares; the pixel's own is 1.
// Pixels of like tones are chosen for that, so their mean has more noise left than that of as many others: twice as
// much, by trials.
RT_FN float denoiseGuideVariance(float weights, float squaredWeights) {
    float own = 1.0f - kDenoiseGuideShare + kDenoiseGuideShare / weights;
    float other = kDenoiseGuideShare / weights;
    return min(1.0f, 2.0f * (own * own + other * other * (squaredWeights - 1.0f)));
}

RT_SHARED_END

#endif
