// Sampling of spheres: uniform in area, solid angle or projected solid angle, or from inside.
#ifndef RT_SHARED_SPHERE_LIGHT_H
#define RT_SHARED_SPHERE_LIGHT_H
#include "Common/Shared/Light/LightSample.h"
#include "Common/Shared/Light/Projected/ProjectedLights.h"
#include "Common/Shared/Shape/Shapes.h"

RT_SHARED_BEGIN

RT_FN vec3 sphereLightCenter(Features features, RT_IN(Light) light, float time) {
    return has(features, kFeatureMovingSpheres) ? light.position + light.edgeU * time : light.position;
}

RT_FN uint sphereLightStrategy(Features features, uint method, RT_IN(Light) light, vec3 toCenter, vec3 normal) {
    float d2 = dot(toCenter, toCenter);
    float r2 = light.radius * light.radius;
    uint strategy = method == kShapeArea ? kStrategyArea : kStrategySolidAngle;
    if (method == kShapeAuto) {
        uint near = isSurface(normal) ? kStrategyVisibleCap : kStrategySolidAngle;
        strategy = r2 >= kMinCapSine2 * d2 ? near : kStrategySolidAngle;
    }
    if (wantsProjected(features, method, normal)) {
        strategy = r2 >= kTinyExtent * kTinyExtent * d2 ? kStrategyProjected : kStrategySolidAngle;
    }
    return d2 <= r2 ? kStrategyInside : strategy;
}

// The point of a sample whose direction, distance and normal are known: it must lie on the ray. Near the sphere only
// one form guarantees that, far from it the other is finer.
RT_FN vec3 pointOnSphere(float toCenter, vec3 center, float radius, vec3 normal, vec3 onRay) {
    return select(toCenter < 2.0f * radius, onRay, center + normal * radius);
}

RT_FN LightSample sampleSphereProjected(RT_IN(Light) light, vec3 center, vec3 toCenter, vec3 position, vec3 normal,
                                        vec2 u) {
    LightSample s = noLightSample();
    ProjectedDirection d = sampleProjectedSphere(toCenter, light.radius, normal, u);
    if (!(d.density > 0.0f)) return s;
    s.wi = d.place.direction;
    s.distance = d.place.distance;
    s.normal = d.place.normal;
    s.point = pointOnSphere(length(toCenter), center, light.radius, s.normal, position + s.wi * s.distance);
    s.pdf = d.density * max(dot(normal, s.wi), 0.0f);
    return s;
}

RT_FN float sphereProjectedPdf(RT_IN(Light) light, vec3 toCenter, vec3 normal, vec3 wi) {
    return projectedSphereDensity(toCenter, light.radius, normal, wi) * max(dot(normal, wi), 0.0f);
}

// A sphere from outside: in its cone of directions, or in what of that is above the horizon (isCap), for
// kStrategyVisibleCap. Without a branch that keeps loops over lights from becoming vectors.
RT_FN LightSample sampleSphereCone(RT_IN(Light) light, bool isCap, vec3 center, vec3 position, vec3 normal, vec2 u) {
    SphereCone cone = makeSphereCone(center - position, light.radius);
    ConeSample c;
    float pdf;
    if (isCap) {
        VisibleCapSample visible = sampleVisibleCap(cone, light.radius, normal, u);
        c = visible.place;
        pdf = visible.pdf;
    } else {
        c = sampleSphereCone(cone, light.radius, u);
        pdf = sphereConePdf(cone);
    }
    LightSample s = noLightSample();
    s.wi = c.direction;
    s.distance = c.distance;
    s.normal = c.normal;
    s.point = pointOnSphere(cone.distance, center, light.radius, c.normal, position + c.direction * c.distance);
    s.pdf = pdf;
    return s;
}

// See Shapes.h.
RT_FN bool isNearSphereLight(RT_IN(Light) light) {
    return light.kind == kLightSphere && light.edgeV.y > 0.0f;
}

// A sample whose point is known as well as the shading point and the way from there, not as the light's coordinates.
RT_FN LightSample placeOnNearSphere(RT_IN(Light) light, vec3 position, float time, RT_IN(LightSample) drawn) {
    LightSample s = drawn;
    Ray ray;
    ray.origin = position;
    ray.direction = s.wi;
    ray.time = time;
    float t = intersectSphere(ray, 1.0f / dot(s.wi, s.wi), light.position, light.radius, light.edgeV.x, kInfinity);
    if (!(s.pdf > 0.0f && t > 0.0f)) return s; // beside it, by rounding
    SpherePoint point = spherePoint(ray, light.position, light.radius, light.edgeV.x, t);
    // Rounding may have taken the shading point to be on the other side of the surface, as sphereLightPdf() does.
    if ((dot(point.normal, s.wi) > 0.0f) != (dot(s.normal, s.wi) > 0.0f)) s.pdf = 0.0f;
    s.distance = t;
    s.point = point.position;
    s.normal = point.normal;
    s.error = vec3(4.0f * point.error);
    return s;
}

RT_FN LightSample sampleSphereLight(Features features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position,
                                    vec3 normal, float time, vec2 u) {
    LightSample s = noLightSample();
    vec3 center = sphereLightCenter(features, light, time);
    vec3 toCenter = center - position;
    float radius = light.radius;
    uint strategy = sphereLightStrategy(features, params.sphereLight, light, toCenter, normal);
    if (has(features, kMethodProjected) && strategy == kStrategyProjected) {
        s = sampleSphereProjected(light, center, toCenter, position, normal, u);
    } else if (strategy == kStrategySolidAngle || strategy == kStrategyVisibleCap) {
        s = sampleSphereCone(light, strategy == kStrategyVisibleCap, center, position, normal, u);
    } else if (strategy == kStrategyInside) {
        vec4 w = sampleInside(normal, u);
        s.wi = vec3(w);
        float along = dot(toCenter, s.wi);
        float inside2 = radius * radius - dot(toCenter, toCenter);
        s.distance = along + sqrt(along * along + inside2);
        s.point = position + s.wi * s.distance;
        s.normal = (s.point - center) / radius;
        s.pdf = light.sides == kSidesBoth ? w.w : 0.0f;
    } else {
        s.normal = sampleSphere(u);
        s.point = center + s.normal * radius;
        vec3 v = s.point - position;
        s.distance = length(v);
        s.wi = v / s.distance;
        float cosine = -dot(s.normal, s.wi);
        // The far half is hidden by the near one, and a mixture's density counts the direction once.
        s.pdf = cosine > 0.0f ? areaPdf(light.area, s.distance, cosine) : 0.0f;
    }
    return s;
}

RT_FN float sphereLightPdf(Features features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position,
                           vec3 normal, float time, vec3 wi, float distance, vec3 lightNormal) {
    vec3 toCenter = sphereLightCenter(features, light, time) - position;
    uint strategy = sphereLightStrategy(features, params.sphereLight, light, toCenter, normal);
    // Samples lie on the near side, from inside on the far one. Near a huge sphere rounding may take the point to be
    // inside.
    if ((dot(lightNormal, wi) > 0.0f) != (strategy == kStrategyInside)) return 0.0f;
    if (has(features, kMethodProjected) && strategy == kStrategyProjected)
        return sphereProjectedPdf(light, toCenter, normal, wi);
    if (strategy == kStrategySolidAngle) return sphereConePdf(makeSphereCone(toCenter, light.radius));
    if (strategy == kStrategyVisibleCap) return visibleCapPdf(makeSphereCone(toCenter, light.radius), normal, wi);
    if (strategy == kStrategyArea) return areaPdf(light.area, distance, dot(lightNormal, wi));
    return isSurface(normal) ? max(dot(normal, wi), 0.0f) * kInvPi : 0.25f * kInvPi;
}

RT_SHARED_END

#endif
