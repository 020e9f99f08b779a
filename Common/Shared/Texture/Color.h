// The sRGB encoding of 8-bit textures.
#ifndef RT_SHARED_COLOR_H
#define RT_SHARED_COLOR_H
#include "Common/Shared/Base/Elementary.h"

RT_SHARED_BEGIN

// IEC 61966-2-1: encoded value in [0,1] to linear.
RT_FN float srgbToLinear(float c) {
    return c <= 0.04045f ? c / 12.92f : exponential(2.4f * logarithm((max(c, 0.04045f) + 0.055f) / 1.055f));
}

// Linear colour of a texel of format kTexelSrgb8.
RT_FN vec3 decodeSrgb8(uint word) {
    vec3 c = vec3(float(word & 255u), float(word >> 8u & 255u), float(word >> 16u & 255u)) / 255.0f;
    return vec3(srgbToLinear(c.x), srgbToLinear(c.y), srgbToLinear(c.z));
}

RT_SHARED_END

#endif
