// A sphere wholly above the horizon of a surface, by projected solid angle: seen along the surface's normal the cap of
// directions to the sphere is an ellipse, in which points are uniform. An unoccluded diffuse receiver then sees no
// variance, at the price of uniform solid angle. (The case without a cut of Urena & Georgiev, "Stratified Sampling of
// Projected Spherical Caps", 2018, in a form for caps that are not small; ProjectedCap.h holds all cases and sizes.)
#ifndef RT_SHARED_VISIBLE_CAP_H
#define RT_SHARED_VISIBLE_CAP_H
#include "Common/Shared/Shape/SphericalShapes.h"

RT_SHARED_BEGIN

// Square of the sine of the cone below which the cosine hardly varies within it, and directions from its axis lose
// digits.
const float kLeastCapSine2 = 1.0e-3f;

// Density per steradian of wi, a direction to the sphere; `normal` unit, the cosine between it and the axis at least
// the sine.
RT_FN float visibleCapPdf(RT_IN(SphereCone) cone, vec3 normal, vec3 wi) {
    return max(dot(normal, wi), 0.0f) * kInvPi / (cone.sine * cone.sine * dot(normal, cone.axis));
}

RT_FN ConeSample sampleVisibleCap(RT_IN(SphereCone) cone, float radius, vec3 normal, vec2 u) {
    Frame f = makeFrame(normal);
    // The ellipse around the axis, as seen along the normal, is a disk that is squeezed by their cosine along `axis`.
    vec2 axis = vec2(dot(cone.axis, f.tangent), dot(cone.axis, f.bitangent));
    vec2 e = sampleDisk(u);
    e -= axis * (dot(e, axis) / (1.0f + dot(cone.axis, normal)));
    vec2 q = axis * cone.cosine + e * cone.sine;
    vec3 direction = f.tangent * q.x + f.bitangent * q.y + normal * sqrt(max(1.0f - dot(q, q), 0.0f));
    float cosine = dot(direction, cone.axis);
    vec3 across = direction - cone.axis * cosine;
    float sine2 = min(dot(across, across), cone.sine * cone.sine);
    return meetSphere(cone, radius, direction, cosine, across, sine2);
}

RT_SHARED_END

#endif
