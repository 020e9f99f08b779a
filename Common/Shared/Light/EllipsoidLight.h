// Sampling of ellipsoids, which spheres become when they are scaled unequally: by the cone of the unit sphere that they
// are the image of (Ellipsoids.h). There is no projected sampling.
#ifndef RT_SHARED_ELLIPSOID_LIGHT_H
#define RT_SHARED_ELLIPSOID_LIGHT_H
#include "Common/Shared/Light/LightSample.h"
#include "Common/Shared/Shape/Ellipsoids.h"

RT_SHARED_BEGIN

RT_FN Ellipsoid ellipsoidOf(RT_IN(Light) light) {
    return makeEllipsoid(light.edgeU, light.edgeV, light.normal);
}

// `center`: from the shading point, in the sphere's own space.
RT_FN uint ellipsoidLightStrategy(RT_IN(RenderParams) params, vec3 center) {
    if (dot(center, center) <= 1.0f) return kStrategyInside;
    return params.sphereLight == kShapeArea ? kStrategyArea : kStrategySolidAngle;
}

// As sampleLight and lightPdf (Lights.h), whose parameters these are.
RT_CALL LightSample sampleEllipsoidLight(RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position, vec3 normal,
                                         vec2 u) {
    LightSample s = noLightSample();
    Ellipsoid e = ellipsoidOf(light);
    vec3 toCenter = light.position - position;
    vec3 center = toSphere(e, toCenter);
    uint strategy = ellipsoidLightStrategy(params, center);
    if (strategy == kStrategyInside) {
        vec4 w = sampleInside(normal, u);
        s.wi = vec3(w);
        EllipsoidHit hit = intersectEllipsoid(e, center, s.wi);
        s.distance = hit.distance;
        s.point = position + s.wi * s.distance;
        s.normal = ellipsoidNormal(e, hit.onSphere);
        s.pdf = light.sides == kSidesBoth ? w.w : 0.0f;
        return s;
    }
    bool byArea = strategy == kStrategyArea;
    EllipsoidCone cone = makeEllipsoidCone(e, center);
    EllipsoidConeSample drawn = sampleEllipsoidCone(cone, u);
    vec3 onSphere = byArea ? sampleSphere(u) : drawn.onSphere;
    // The point must lie on the ray; near the ellipsoid only the direction guarantees it, far from it its own place is
    // finer.
    bool close = !byArea && cone.distance < 2.0f;
    vec3 fromCenter = fromSphere(e, onSphere);
    vec3 toPoint = close ? fromSphere(e, drawn.toPoint) : toCenter + fromCenter;
    s.distance = length(toPoint);
    s.wi = toPoint / s.distance;
    s.point = close ? position + toPoint : light.position + fromCenter;
    s.normal = ellipsoidNormal(e, onSphere);
    s.pdf = byArea ? ellipsoidAreaPdf(e, s.normal, s.wi, s.distance) : ellipsoidConePdf(e, cone, s.wi);
    return s;
}

RT_CALL float ellipsoidLightPdf(RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position, vec3 normal, vec3 wi,
                                float distance, vec3 lightNormal) {
    Ellipsoid e = ellipsoidOf(light);
    vec3 center = toSphere(e, light.position - position);
    uint strategy = ellipsoidLightStrategy(params, center);
    // Samples lie on the near side, from inside on the far one.
    if ((dot(lightNormal, wi) > 0.0f) != (strategy == kStrategyInside)) return 0.0f;
    if (strategy == kStrategyInside) return isSurface(normal) ? max(dot(normal, wi), 0.0f) * kInvPi : 0.25f * kInvPi;
    if (strategy == kStrategyArea) return ellipsoidAreaPdf(e, lightNormal, wi, distance);
    return ellipsoidConePdf(e, makeEllipsoidCone(e, center), wi);
}

RT_SHARED_END

#endif
