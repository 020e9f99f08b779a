// Distances of pixels, which patches are made of, for the denoiser's kernels. Everything here has internal linkage.
#pragma once
#include "Common/Shared/Denoise/DenoiseWeights.h"

namespace rt::image {
namespace {

// Of `kCount` pixels from `here` on and as many from `there` on, in planes of tones and of their variance.
template <int kCount>
RT_CALL void measurePixels(const float* const (&tones)[3], const float* variance, int here, int there,
                           float* distances) {
    const float *r0 = tones[0] + here, *g0 = tones[1] + here, *b0 = tones[2] + here;
    const float *r1 = tones[0] + there, *g1 = tones[1] + there, *b1 = tones[2] + there;
    const float *v0 = variance + here, *v1 = variance + there;
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC ivdep
#endif
    for (int i = 0; i < kCount; ++i) {
        const float r = r0[i] - r1[i], g = g0[i] - g1[i], b = b0[i] - b1[i];
        distances[i] = shared::denoiseDistance(r * r + g * g + b * b, v0[i], v1[i]);
    }
}

} // namespace
} // namespace rt::image
