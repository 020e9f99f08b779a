// Homogeneous participating media in convex boundaries: the stretch of a ray inside one, free flight and transmittance.
#ifndef RT_SHARED_MEDIA_H
#define RT_SHARED_MEDIA_H
#include "Common/Shared/Base/Sampling.h"

RT_SHARED_BEGIN

RT_FN vec3 transformPoint(vec4 row0, vec4 row1, vec4 row2, vec3 p) {
    return vec3(dot(vec3(row0), p) + row0.w, dot(vec3(row1), p) + row1.w, dot(vec3(row2), p) + row2.w);
}
RT_FN vec3 transformVector(vec4 row0, vec4 row1, vec4 row2, vec3 v) {
    return vec3(dot(vec3(row0), v), dot(vec3(row1), v), dot(vec3(row2), v));
}

// Parameters (near, far) of the line o + t d in the unit sphere, near >= far if it misses; d of any length.
RT_FN vec2 unitSphereInterval(vec3 o, vec3 d) {
    // The discriminant from the perpendicular distance, the roots without cancellation (Haines et al., Ray Tracing
    // Gems, chapter 7).
    float a = dot(d, d);
    float b = -dot(o, d);
    vec3 l = o + d * (b / a);
    float discriminant = 1.0f - dot(l, l);
    float o1 = length(o);
    float c = (o1 - 1.0f) * (o1 + 1.0f);
    float q = b + signOf(b) * sqrt(a * max(discriminant, 0.0f));
    float t0 = c / (q == 0.0f ? 1.0f : q);
    float t1 = q / a;
    bool misses = discriminant <= 0.0f || q == 0.0f;
    return misses ? vec2(1.0f, 0.0f) : vec2(min(t0, t1), max(t0, t1));
}

// The same for the cube [-1, 1]^3. A direction in a slab's planes gets a component too small to matter: no 0 *
// infinity.
RT_FN vec2 unitBoxInterval(vec3 o, vec3 d) {
    vec3 s = vec3(signOf(d.x), signOf(d.y), signOf(d.z));
    vec3 inverse = s / max(abs(d), vec3(1.0e-30f));
    vec3 near = (-s - o) * inverse;
    vec3 far = (s - o) * inverse;
    return vec2(maxComponent(near), min(far.x, min(far.y, far.z)));
}

// Stretch (near, far) of the line inside the medium in parameters of `direction`, empty if near >= far. `near` is
// negative where the origin is inside. Exact roots, no tolerance: neighbouring and nested media meet without gap.
RT_FN vec2 mediumInterval(RT_IN(Medium) m, vec3 origin, vec3 direction) {
    vec3 o = transformPoint(m.toLocal[0], m.toLocal[1], m.toLocal[2], origin);
    vec3 d = transformVector(m.toLocal[0], m.toLocal[1], m.toLocal[2], direction);
    return m.shape == kMediumSphere ? unitSphereInterval(o, d) : unitBoxInterval(o, d);
}

// Length of the part of an interval within [0, tMax].
RT_FN float lengthWithin(vec2 interval, float tMax) {
    return max(min(interval.y, tMax) - max(interval.x, 0.0f), 0.0f);
}

// Distance to the next collision in a medium without end; u in [0,1), fine near 0 (sampleFine): thin media need its
// bits.
RT_FN float sampleFreeFlight(float u, float extinction) {
    return -log1p(-u) / extinction;
}

RT_FN float transmittance(float opticalDepth) {
    return exponential(-opticalDepth);
}

// 1 - transmittance, without cancellation in thin media.
RT_FN float collisionProbability(float opticalDepth) {
    return -expm1(-opticalDepth);
}

RT_SHARED_END

#endif
