// The density of a direction under the sampling of one light, whatever stands in between: what a mixture sums over
// lights.
#ifndef RT_SHARED_LIGHT_DENSITY_H
#define RT_SHARED_LIGHT_DENSITY_H
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Light/Lights.h"

RT_SHARED_BEGIN

// Where a ray meets a light: distance (0: nowhere) and the front normal there.
struct LightIntersection {
    float distance;
    vec3 normal;
};

RT_FN LightIntersection intersectSphereLight(RT_IN(Light) light, vec3 position, float time, vec3 wi) {
    LightIntersection c;
    c.distance = 0.0f;
    c.normal = -wi;
    vec3 f = position - (light.position + light.edgeU * time);
    float along = -dot(f, wi);
    vec3 foot = f + wi * along;
    float squared = light.radius * light.radius - dot(foot, foot);
    if (!(squared >= 0.0f)) return c;
    float halfChord = sqrt(squared);
    float sign = along > halfChord ? -1.0f : 1.0f; // from inside, the far side
    float t = along + sign * halfChord;
    if (!(t > 0.0f)) return c;
    c.distance = t;
    c.normal = normalize(foot + wi * (sign * halfChord));
    return c;
}

RT_FN LightIntersection intersectEllipsoidLight(RT_IN(Light) light, vec3 position, vec3 wi) {
    Ellipsoid e = ellipsoidOf(light);
    EllipsoidHit hit = intersectEllipsoid(e, toSphere(e, light.position - position), wi);
    LightIntersection c;
    c.distance = max(hit.distance, 0.0f);
    c.normal = ellipsoidNormal(e, hit.onSphere);
    return c;
}

RT_FN LightIntersection intersectFlatLight(RT_IN(Light) light, vec3 position, vec3 wi) {
    LightIntersection c;
    c.distance = 0.0f;
    c.normal = light.normal;
    float cosine = dot(light.normal, wi);
    if (cosine == 0.0f) return c;
    float t = dot(light.normal, light.position - position) / cosine;
    if (!(t > 0.0f && t < kInfinity)) return c;
    vec2 at = edgeCoordinates(light, position + wi * t - light.position);
    float maximum = light.kind == kLightTriangle ? at.x + at.y : max(at.x, at.y);
    bool inside = at.x >= 0.0f && at.y >= 0.0f && maximum <= 1.0f;
    if (inside) c.distance = t;
    return c;
}

RT_FN LightIntersection intersectRoundLight(RT_IN(Light) light, vec3 position, float time, vec3 wi) {
    Ray ray;
    ray.origin = position;
    ray.direction = wi;
    ray.time = time;
    Round r;
    r.origin = light.position;
    r.edgeU = light.edgeU;
    r.edgeV = light.edgeV;
    r.axis = light.normal;
    r.hole = light.kind == kLightDisk ? light.radius : -1.0f;
    r.material = light.material;
    r.light = kNone;
    float t = intersectRound(ray, r.origin, roundFrame(r.edgeU, r.edgeV, r.axis), r.hole, kInfinity);
    LightIntersection c;
    c.distance = max(t, 0.0f);
    c.normal = light.normal;
    if (t > 0.0f) c.normal = roundPoint(ray, r, t).normal;
    return c;
}

// Density over solid angle of wi under sampleLight; 0 where wi misses the light.
RT_FN float lightPdfAlong(Features features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position, vec3 normal,
                          float time, vec3 wi) {
    LightIntersection c;
    if (has(features, kFeatureSphereLights) && light.kind == kLightSphere) {
        c = intersectSphereLight(light, position, time, wi);
    } else if (has(features, kFeatureEllipsoidLights) && light.kind == kLightEllipsoid) {
        c = intersectEllipsoidLight(light, position, wi);
    } else if (has(features, kRoundLightFeatures) && isRoundLight(features, light)) {
        if (!isCylinderLight(features, light) && !isLit(light, position)) return 0.0f;
        c = intersectRoundLight(light, position, time, wi);
    } else {
        if (!isLit(light, position)) return 0.0f;
        c = intersectFlatLight(light, position, wi);
    }
    if (!(c.distance > 0.0f)) return 0.0f;
    return lightPdf(features, params, light, position, normal, time, wi, c.distance, c.normal);
}

RT_SHARED_END

#endif
