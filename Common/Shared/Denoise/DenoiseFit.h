// What the denoiser fits radiance by: features of the surface in sight and the position, as both engines scale and
// bound them. See docs/denoising.md.
#ifndef RT_SHARED_DENOISE_FIT_H
#define RT_SHARED_DENOISE_FIT_H
#include "Common/Shared/Base/Elementary.h"
#include "Common/Shared/Base/Shim.h"

RT_SHARED_BEGIN

const int kDenoiseTile = 32;                // pixels a side of what shares its features
const int kDenoiseSurfaceValues = 7;        // albedo, normal, depth
const int kDenoiseSurfaceFeatures = 4;      // at most: more were measured to gain 1 % and to cost a third of the time
const int kDenoiseFeatures = 7;             // with 1 and both coordinates
const float kDenoiseFeatureNoise = 3.0e-2f; // an axis of the surface's values with less variance tells too little
const float kDenoisePixel = 0.1f; // from one pixel to the next: coordinates are small, as surface's features are

const float kDenoiseRidge = 1.0e-3f; // of the sum of weights: a feature that varies by much less has no say
const float kDenoiseTiny = 1.0e-6f;  // keeps the system regular where nothing varies

// A value of the surface, finite and at most 2, before it is scaled.
RT_FN float denoiseBounded(float value, float minimum) {
    return isFinite(value) ? clamp(value, minimum, 2.0f) : 0.0f;
}
// Of albedo and of depth a difference of a quarter is as much as one of 1; of the normal, of a half.
RT_FN float denoiseAlbedo(float albedo) {
    return 4.0f * denoiseBounded(albedo, 0.0f);
}
RT_FN float denoiseNormal(float component) {
    return 2.0f * denoiseBounded(component, -2.0f);
}
// `usual`: what nearly all pixels that see something are nearer than.
RT_FN float denoiseDepth(float depth, float usual) {
    return 4.0f * denoiseBounded(depth / usual, 0.0f);
}

// From a pixel to the one beside it in its square of 2x2, along an axis where `step` is not 0: the other way for an odd
// coordinate.
RT_FN int denoisePartner(int step, int coordinate) {
    return step == 0 ? 0 : 1 - 2 * (coordinate & 1);
}

RT_SHARED_END

#endif
