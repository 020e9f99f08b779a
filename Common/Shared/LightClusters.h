// How much a group of lights may contribute at a point, by which the tree of lights is descended.
#ifndef RT_SHARED_LIGHT_CLUSTERS_H
#define RT_SHARED_LIGHT_CLUSTERS_H
#include "Lights.h"

RT_SHARED_BEGIN

// Estimate of the irradiance that the lights of a cluster cause without occluders. 0 only where none of them can
// contribute: all below the horizon of `normal` (zero: in a medium), or all turned away from the point. Without a branch.
RT_FN float clusterContribution(RT_IN(LightCluster) c, vec3 position, vec3 normal) {
    vec3 v = c.center - position;
    float d2 = dot(v, v);
    float r2 = c.radius * c.radius;
    float inverse2 = 1.0f / max(d2, 0.25f * r2);
    float inverse = sqrt(inverse2);
    float receiver = isSurface(normal) ? meanClamped(dot(normal, v), c.radius) * inverse : 1.0f;
    // The cosines under which the flat lights emit: their mean, as seen from the middle, and their maximum, with the
    // cone widened by the angle that the sphere fills.
    float cosine = clamp(-dot(c.axis, v) / sqrt(max(d2, 1.0e-37f)), -1.0f, 1.0f);
    float sine = sqrt((1.0f - cosine) * (1.0f + cosine));
    bool leaf = (c.child & kLightLeaf) != 0u; // a plane is in front of a point or not, whatever the angle it fills
    float fill2 = leaf ? 0.0f : min(r2 / max(d2, 1.0e-37f), 1.0f);
    float fillSine = sqrt(fill2);
    float fillCosine = sqrt(1.0f - fill2);
    float wideCosine = c.spreadCosine * fillCosine - c.spreadSine * fillSine;
    float wideSine = c.spreadSine * fillCosine + c.spreadCosine * fillSine;
    // A hair wider than rounding.
    float highest = cosine * wideCosine + sine * wideSine + 2.0e-6f;
    highest = cosine >= wideCosine - 1.0e-6f ? 1.0f : highest;
    highest = wideSine < 0.0f ? 1.0f : highest;
    highest = fill2 >= 1.0f ? 1.0f : highest;
    float mean = cosine * c.alignment;
    highest = leaf ? mean : highest;
    mean = c.facing < 0.0f ? abs(mean) : mean;
    float emitter = meanClamped(mean, max(highest - mean, 0.0f));
    return (c.around + abs(c.facing) * emitter) * receiver * inverse2;
}

RT_SHARED_END

#endif
