// How much one light may contribute at a point, by which lights are chosen.
#ifndef RT_SHARED_LIGHT_CONTRIBUTION_H
#define RT_SHARED_LIGHT_CONTRIBUTION_H
#include "Common/Shared/Light/LightSample.h"

RT_SHARED_BEGIN

// Mean of max(x, 0) over x uniform in [middle - spread, middle + spread], spread >= 0: `middle` where the interval is
// positive, a parabola that reaches 0 with slope 0 where it sinks below 0.
RT_FN float meanClamped(float middle, float spread) {
    // Where the interval is positive the parabola of a wider one, as wide as it can be, has the same value.
    float wide = max(max(spread, middle), 1.0e-30f);
    float above = max(middle + wide, 0.0f);
    return above * (above / (4.0f * wide));
}

// Estimate of the irradiance that the light behind `bound` causes without occluders, for the choice of a light: exact
// for small and distant lights, and 0 only where the light cannot contribute: wholly below the horizon of `normal`, or
// the point is not in front of a one-sided flat light. `normal` as in sampleLight. Without a branch, for loops over
// lights.
RT_FN float lightContribution(RT_IN(LightBound) bound, vec3 position, vec3 normal) {
    vec3 v = bound.center - position;
    float d2 = dot(v, v);
    float r = bound.radius;
    float r2 = r * r;
    float inverse = inversesqrt(max(d2, 0.25f * r2));
    float surface = isSurface(normal) ? 1.0f : 0.0f;
    float receiver = surface * (meanClamped(dot(normal, v), r) * inverse) + (1.0f - surface);
    float facing = -dot(bound.axis, v);
    facing = max(facing, -facing * bound.twoSided);
    float emitter = bound.omnidirectional + facing * inverse;
    return bound.intensity * receiver * emitter * (inverse * inverse);
}

RT_SHARED_END

#endif
