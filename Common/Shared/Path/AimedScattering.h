// Scattering aimed at a sphere of glass, which focuses the light of lamps: scattering by chance alone finds few of the
// paths that lead through the sphere, of which each then brings much. Where paths are shared (PathReuse.h), a share of
// the directions from the first vertex is drawn towards the sphere, nearly by projected solid angle; the density is
// that of the mixture, whichever part a direction comes from. Shirley, "Ray Tracing: The Rest of Your Life", mixes
// likewise; here the share follows from how much of the light at the vertex is thought to come by way of the sphere.
#ifndef RT_SHARED_AIMED_SCATTERING_H
#define RT_SHARED_AIMED_SCATTERING_H
#include "Common/Shared/Light/Projected/VisibleCap.h"
#include "Common/Shared/Path/PathReuse.h"

RT_SHARED_BEGIN

// Of the directions from a vertex to which all light comes by way of the sphere.
const float kMaxAimed = 0.7f;

RT_FN bool aimsPaths(Features features, RT_IN(RenderParams) params) {
    return has(features, kMethodReuse) && params.pathReuse == kPathReuseAimed;
}

// Share of the directions from x that are drawn towards the sphere; `direct` is LightContext::total there.
RT_FN float aimedShare(RT_IN(AimedSphere) sphere, vec3 x, float direct) {
    vec3 toCenter = sphere.center - x;
    float inverse = 1.0f / sqrt(max(dot(toCenter, toCenter), 1.0e-30f));
    float near = sphere.radius * inverse;
    float aimed = sphere.gain * near * near;
    bool isOutside = near < kNearestToSphere;
    bool isReached = -dot(toCenter, sphere.axis) * inverse > sphere.limit;
    float share = isOutside ? kMaxAimed * aimed / (aimed + direct) : 0.0f;
    return isReached ? share : 0.0f;
}

RT_FN SphereCone aimedCone(RT_IN(AimedSphere) sphere, vec3 x) {
    return makeSphereCone(sphere.center - x, sphere.radius);
}

// What mixing makes of the density with which a diffuse surface scatters to wi: a factor. `cosine` is that of wi and
// the cone's axis, or 2 where wi has been drawn towards the sphere.
RT_FN float aimedRatio(RT_IN(SphereCone) cone, vec3 normal, float share, vec3 wi, float cosine) {
    float density = min(kPi * capDensityAlong(cone, normal, wi), 1.0e30f); // the surface's own is 1
    return (1.0f - share) + (cosine > cone.cosine ? share : 0.0f) * density;
}

// The factor for y as seen from the vertex at x, of which this share is aimed.
RT_FN float aimedRatioTowards(RT_IN(AimedSphere) sphere, vec3 x, vec3 normal, float share, vec3 y) {
    if (!(share > 0.0f)) return 1.0f;
    SphereCone cone = aimedCone(sphere, x);
    vec3 wi = normalize(y - x);
    return aimedRatio(cone, normal, share, wi, dot(wi, cone.axis));
}

// Replaces b, what the diffuse surface at v has sampled, by a sample of the mixture; `u` decides which of its parts
// that comes from. Without a branch, for loops over lanes: with no share b as it was.
RT_FN BsdfSample aimScattering(RT_IN(AimedSphere) sphere, RT_IN(Vertex) v, vec2 direction, float u, float share,
                               RT_IN(BsdfSample) b) {
    bool isAimed = u < share;
    SphereCone cone = aimedCone(sphere, v.origin);
    vec3 towards = sampleVisibleCap(cone, sphere.radius, v.normal, direction).place.direction;
    BsdfSample mixed = b;
    mixed.wi = select(isAimed, towards, b.wi);
    float pdf = max(dot(towards, v.normal), 0.0f) * kInvPi;
    mixed.pdf = isAimed ? pdf : b.pdf;
    float cosine = isAimed ? 2.0f : dot(b.wi, cone.axis);
    float ratio = aimedRatio(cone, v.normal, share, mixed.wi, cosine);
    mixed.weight = b.weight * (mixed.pdf > 0.0f ? 1.0f / ratio : 0.0f);
    return mixed;
}

RT_SHARED_END

#endif
