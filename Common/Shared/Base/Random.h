// Counter-based random numbers: (pixel, sample, dimension, seed) -> number, the same on both engines and for any
// scheduling. A path's decisions have fixed dimensions; features decide which are evaluated, never which number a
// decision gets. All uniforms lie on the grid k 2^-24 in [0, 1 - 2^-24] unless a function says otherwise.
#ifndef RT_SHARED_RANDOM_H
#define RT_SHARED_RANDOM_H
#include "Common/Shared/Base/Types.h"

RT_SHARED_BEGIN

// ---- dimensions ----------------------------------------------------------------------------------------------------
// A sample dimension is a 2D point of the unit square. Dimensions of the camera come first, then kDimensionsPerVertex
// for each vertex of the path.
const uint kDimensionPixel = 0u; // position in the pixel
const uint kDimensionLens = 1u;  // position on the lens
const uint kDimensionTime = 2u;  // x: time in the shutter interval
const uint kCameraDimensions = 4u;
const uint kDimensionLight = 0u;     // choice of the light, stretched, and position on it
const uint kDimensionBsdf = 1u;      // lobe or direction of the scattered ray
const uint kDimensionRoulette = 2u;  // x: survival of the roulette, y: technique of the mixture
const uint kDimensionSelection = 3u; // choice of the light where there are too many to stretch kDimensionLight
const uint kDimensionMedium = 4u;    // x: free flight in medium 0; medium m uses dimension kDimensionMedium + (m << 16)
const uint kDimensionsPerVertex = 8u;

RT_FN uint vertexDimension(uint vertex, uint dimension) {
    return kCameraDimensions + vertex * kDimensionsPerVertex + dimension;
}

// ---- hashing -------------------------------------------------------------------------------------------------------

// Three words to three words. Jarzynski & Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020: pcg3d.
RT_FN uvec3 hash3(uvec3 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v = v ^ (v >> 16u);
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

// A bijection of 32-bit words with full avalanche (the constants are those found by Wellons' search for low bias).
RT_FN uint hash1(uint x) {
    x ^= x >> 16u;
    x *= 0x21f0aaadu;
    x ^= x >> 15u;
    x *= 0xd35a2d97u;
    x ^= x >> 15u;
    return x;
}

RT_FN float toUniform(uint x) {
    return float(x >> 8u) * 5.9604644775390625e-8f;
}

// In [0,1) with 48 random bits, fine near 0: for free flights through thin media.
RT_FN float toFineUniform(uint high, uint low) {
    return min(float(high >> 8u) * 5.9604644775390625e-8f + float(low >> 8u) * 3.5527136788005009e-15f,
               0.999999940395355f);
}

RT_FN vec2 toUniform2(uvec2 words) {
    return vec2(toUniform(words.x), toUniform(words.y));
}

// u, known to lie in [low, high) of a distribution function, stretched to [0,1): reuses a number after a choice.
RT_FN float stretch(float u, float low, float high) {
    return clamp((u - low) / (high - low), 0.0f, 0.999999940395355f);
}

RT_SHARED_END

#endif
