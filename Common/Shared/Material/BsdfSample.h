// What sampling a bsdf returns. Directions point away from the surface, `n` is the unit shading normal on the side of
// wo. Densities are per steradian; `weight` is value * |cosine| / density, so no division is left to the caller.
#ifndef RT_SHARED_BSDF_SAMPLE_H
#define RT_SHARED_BSDF_SAMPLE_H
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Base/Sampling.h"

RT_SHARED_BEGIN

struct BsdfSample {
    vec3 wi;
    vec3 weight;      // zero: absorbed
    float pdf;        // 0 for a delta lobe
    uint delta;       // 1: wi is the only direction of its lobe, next-event estimation cannot meet it
    uint transmitted; // 1: wi lies on the other side of the surface
};

RT_FN BsdfSample absorbed() {
    BsdfSample s;
    s.wi = vec3(0.0f);
    s.weight = vec3(0.0f);
    s.pdf = 0.0f;
    s.delta = 0u;
    s.transmitted = 0u;
    return s;
}

RT_FN vec3 mirrorDirection(vec3 wo, vec3 n) {
    return normalize(n * (2.0f * dot(n, wo)) - wo);
}

RT_SHARED_END

#endif
