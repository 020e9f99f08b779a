// Sampling of one light: a direction towards it, and the density of that direction given this light. sampleLight and
// lightPdf take every decision from the same function of the light and the shading point, never from the sample.
#ifndef RT_SHARED_LIGHTS_H
#define RT_SHARED_LIGHTS_H
#include "Common/Shared/Light/EllipsoidLight.h"
#include "Common/Shared/Light/QuadLight.h"
#include "Common/Shared/Light/RoundLight.h"
#include "Common/Shared/Light/SphereLight.h"
#include "Common/Shared/Light/TriangleLight.h"

RT_SHARED_BEGIN

// Whether a point lies on the side that a flat light illuminates.
RT_FN bool isLit(RT_IN(Light) light, vec3 position) {
    return light.sides == kSidesBoth || dot(light.normal, position - light.position) > 0.0f;
}

// Bound of the error per axis of a point sampled on the light, for offsetOrigin at the light's end of a shadow ray:
// several times that of the point itself, since the device that traces the ray also rounds when it tests the light's
// shape.
RT_FN vec3 lightPointError(Features features, RT_IN(Light) light) {
    if (has(features, kFeatureEllipsoidLights) && light.kind == kLightEllipsoid) {
        return ellipsoidError(ellipsoidOf(light), light.position);
    }
    if (light.kind == kLightSphere) {
        float reach = maxComponent(abs(light.position) + abs(light.edgeU)) + light.radius;
        return vec3(32.0f * kEpsilon * reach);
    }
    if (has(features, kRoundLightFeatures) && isRoundLight(features, light)) return roundLightError(light);
    return 32.0f * kEpsilon * (abs(light.position) + abs(light.edgeU) + abs(light.edgeV)) +
           extentError(light.edgeU, light.edgeV);
}

// A sample of `light` as its shape gave it, with what all shapes have in common, and the density 0 where it is useless.
RT_FN LightSample completeSample(Features features, RT_IN(Light) light, vec3 normal, RT_IN(LightSample) drawn) {
    LightSample s = drawn;
    s.radiance = light.emission;
    s.error = lightPointError(features, light);
    // Rounding may let the point coincide with the shading point, and the direction run within the light's plane, which
    // is then infinitely far, or behind.
    bool isAhead = s.distance > 0.0f && s.distance < kInfinity;
    if (!(s.pdf < kInfinity && isAhead && dot(s.wi, s.wi) < 2.0f)) s.pdf = 0.0f;
    if (isSurface(normal) && dot(normal, s.wi) <= 0.0f) s.pdf = 0.0f;
    return s;
}

// `normal` is the shading point's geometric normal on the side of wo, zero for a point in a medium. The sky is not
// sampled here (Sky.h).
RT_FN LightSample sampleLight(Features features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position,
                              vec3 normal, float time, vec2 u) {
    LightSample s = noLightSample();
    if (has(features, kFeatureSphereLights) && light.kind == kLightSphere) {
        s = sampleSphereLight(features, params, light, position, normal, time, u);
    } else if (has(features, kFeatureEllipsoidLights) && light.kind == kLightEllipsoid) {
        s = sampleEllipsoidLight(params, light, position, normal, u);
    } else if (has(features, kRoundLightFeatures) && isRoundLight(features, light)) {
        if (isCylinderLight(features, light) || isLit(light, position)) {
            s = sampleRoundLight(features, params, light, position, normal, u);
        }
    } else if (light.kind != kLightSky && isLit(light, position)) {
        vec3 corner = light.position - position;
        if (isFlatProjected(features, params, light, corner, normal)) {
            s = sampleFlatProjected(light, corner, position, normal, u);
        } else if (has(features, kFeatureQuadLights) && light.kind == kLightQuad) {
            s = sampleQuadLight(features, params, light, position, normal, u);
        } else if (has(features, kFeatureTriangleLights) && light.kind == kLightTriangle) {
            s = sampleTriangleLight(features, params, light, position, normal, u);
        }
    }
    s = completeSample(features, light, normal, s);
    if (has(features, kFeatureSphereLights) && isNearSphereLight(light)) {
        s = placeOnNearSphere(light, position, time, s);
    }
    return s;
}

// Density of wi under sampleLight, for a direction that meets the light at `distance` under its geometric normal
// `lightNormal`.
RT_FN float lightPdf(Features features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position, vec3 normal,
                     float time, vec3 wi, float distance, vec3 lightNormal) {
    if (has(features, kFeatureSphereLights) && light.kind == kLightSphere) {
        return sphereLightPdf(features, params, light, position, normal, time, wi, distance, lightNormal);
    }
    if (has(features, kFeatureEllipsoidLights) && light.kind == kLightEllipsoid) {
        return ellipsoidLightPdf(params, light, position, normal, wi, distance, lightNormal);
    }
    if (has(features, kRoundLightFeatures) && isRoundLight(features, light)) {
        return roundLightPdf(features, params, light, position, normal, wi, distance, lightNormal);
    }
    vec3 corner = light.position - position;
    if (isFlatProjected(features, params, light, corner, normal)) return flatProjectedPdf(light, corner, normal, wi);
    if (has(features, kFeatureQuadLights) && light.kind == kLightQuad) {
        return quadLightPdf(features, params, light, position, normal, wi, distance);
    }
    if (has(features, kFeatureTriangleLights) && light.kind == kLightTriangle) {
        return triangleLightPdf(features, params, light, position, normal, wi, distance);
    }
    return 0.0f;
}

RT_SHARED_END

#endif
