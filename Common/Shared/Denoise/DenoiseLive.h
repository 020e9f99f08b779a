// The filter for a picture that moves or has just begun: a-trous wavelets that stop at edges after Dammertz et al.
// 2010, "Edge-Avoiding A-Trous Wavelet Transform for fast Global Illumination Filtering". Level by level each half
// becomes a weighted mean of 3x3 pixels twice as far apart as before. The weights are those of DenoiseWeights.h without
// patches, from the tones of the other half. These are filtered along with it, by the same weights, and so is their
// variance, as in Schied et al. 2017, "Spatiotemporal Variance-Guided Filtering": no noise ever chooses its own
// weights. Features of surfaces stop it where samples are too few to tell.
#ifndef RT_SHARED_DENOISE_LIVE_H
#define RT_SHARED_DENOISE_LIVE_H
#include "Common/Shared/Denoise/DenoiseWeights.h"

RT_SHARED_BEGIN

const int kLiveLevels = 5;
const int kLiveReach = 1; // pixels of a level's grid from the one that is filtered, in either direction
const float kLivePerSquaredBandwidth = 1.5f;
const float kLiveAlbedoScale = 8.0f; // a difference of an eighth is as much as the noise of two pixels
const float kLiveNormalScale = 4.0f;
const float kLiveDepthScale = 8.0f;

// Pixels from one of a level's grid to the next.
RT_FN int liveStep(int level) {
    return 1 << level;
}

// Of the linear B-spline, by the distance on a level's grid in one direction.
RT_FN float liveKernel(int offset) {
    return offset == 0 ? 0.5f : 0.25f;
}

// Of a depth along the ray: differences are relative ones. Where nothing is hit it is far from all.
RT_FN float liveDepthFeature(float depth) {
    return depth > 0.0f ? kLiveDepthScale * logarithm(clamp(depth, 1.0e-30f, 1.0e30f)) : -1.0e4f;
}

// Before the kernel's factor. `distance` as denoiseDistance() has it, of a half's tones; `squaredFeatures`: the squared
// difference of both pixels' scaled features.
RT_FN float liveWeight(float distance, float squaredFeatures) {
    return denoiseWeight(max(distance, 0.0f) + squaredFeatures, kLivePerSquaredBandwidth);
}

RT_SHARED_END

#endif
