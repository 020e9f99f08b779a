// How much a group of lights may contribute at a point, by which the tree of lights is descended.
#ifndef RT_SHARED_LIGHT_CLUSTERS_H
#define RT_SHARED_LIGHT_CLUSTERS_H
#include "Common/Shared/Light/LightContribution.h"

RT_SHARED_BEGIN

// Estimate of the irradiance that the lights of a cluster cause without occluders. 0 only where none of them can
// contribute: all below the horizon of `normal` (zero: in a medium), or all turned away from the point. Without a
// branch.
RT_FN float clusterContribution(RT_IN(LightCluster) c, vec3 position, vec3 normal) {
    vec3 v = c.center - position;
    float radius = abs(c.radius);
    float d2 = dot(v, v);
    // Roots and quotients that do not wait for each other: a descent does one node after the other.
    float reach2 = max(d2, 0.25f * (radius * radius));
    float inverse2 = 1.0f / reach2;
    float inverse = inverse2 * sqrt(reach2);
    float surface = isSurface(normal) ? 1.0f : 0.0f;
    float receiver = surface * (meanClamped(dot(normal, v), radius) * inverse) + (1.0f - surface);
    // The cosines under which the flat lights emit: their mean, as seen from the middle, and their maximum, with the
    // cone widened by the angle that the sphere fills. A point in the sphere sees it all around. The plane of a single
    // light, whose radius is negative, is in front of a point or not, whatever the angle it fills.
    float along = -dot(c.axis, v);
    float cosine = along * inverse;
    float sine = sqrt(max(d2 * 1.000001f - along * along, 0.0f)) * inverse; // not below the exact one
    float fill = max(c.radius, 0.0f);
    float fillSine = min(fill * inverse, 1.0f);
    float fillCosine = min(sqrt(max(d2 - fill * fill, 0.0f)) * inverse, 1.0f);
    float spreadSine = sqrt((1.0f - c.spreadCosine) * (1.0f + c.spreadCosine));
    float wideCosine = c.spreadCosine * fillCosine - spreadSine * fillSine;
    float wideSine = spreadSine * fillCosine + c.spreadCosine * fillSine;
    // A hair wider than rounding. Positive `within`: inside the cone, or the cone or the sphere is all around.
    float within = max(cosine - wideCosine + 1.0e-6f, max(-wideSine, fillSine - 0.999999940395355f));
    float highest = within > 0.0f ? 1.0f : cosine * wideCosine + sine * wideSine + 2.0e-6f;
    float mean = cosine * c.meanResultantLength;
    mean = c.planarIntensity < 0.0f ? abs(mean) : mean;
    float emitter = meanClamped(mean, max(highest - mean, 0.0f));
    return (c.omnidirectionalIntensity + abs(c.planarIntensity) * emitter) * receiver * inverse2;
}

RT_SHARED_END

#endif
