// What every sampler's numbers depend on.
#ifndef RT_SHARED_PIXEL_SAMPLER_H
#define RT_SHARED_PIXEL_SAMPLER_H
#include "Common/Shared/Base/Random.h"

RT_SHARED_BEGIN

struct Sampler {
    uint kind;  // Samplers.h: kSampler...
    uint key;   // of the pixel, the seed and the replicate
    uint index; // of the sample in the pixel
    uint base;  // of the pixel's samples in Sobol's sequence
    uint strataX;
    uint strataY;
};

// Whose pixels have nothing to do with each other.
RT_FN Sampler pixelSampler(RT_IN(RenderParams) params, uint pixel, uint replicate, uint index) {
    Sampler s;
    s.kind = params.samplerKind;
    s.key = hash3(uvec3(pixel, params.seed, replicate)).x;
    s.index = index;
    s.base = 0u;
    s.strataX = params.strataX;
    s.strataY = params.strataY;
    return s;
}

RT_SHARED_END

#endif
