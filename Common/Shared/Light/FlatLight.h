// What the sampling of quads and triangles has in common.
#ifndef RT_SHARED_FLAT_LIGHT_H
#define RT_SHARED_FLAT_LIGHT_H
#include "Common/Shared/Light/LightSample.h"
#include "Common/Shared/Light/Projected/ProjectedLights.h"

RT_SHARED_BEGIN

// Whether a quad or triangle is sampled by projected solid angle from a point, `corner` relative to it. One that should
// be but is too small for it is sampled by area.
RT_FN bool isFlatProjected(Features features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 corner,
                           vec3 normal) {
    bool quad = has(features, kFeatureQuadLights) && light.kind == kLightQuad &&
                wantsProjected(features, params.quadLight, normal);
    bool triangle = has(features, kFeatureTriangleLights) && light.kind == kLightTriangle &&
                    wantsProjected(features, params.triangleLight, normal);
    if (!quad && !triangle) return false;
    vec3 toMiddle = corner + (light.edgeU + light.edgeV) * (quad ? 0.5f : 1.0f / 3.0f);
    float extent2 = dot(light.edgeU, light.edgeU) + dot(light.edgeV, light.edgeV);
    return extent2 >= kTinyExtent * kTinyExtent * dot(toMiddle, toMiddle);
}

// Automatic: a flat light whose extent is below a tenth of its distance subtends nearly the same solid angle per area
// everywhere, so the cheaper sampler is as good.
RT_FN bool isFar(vec3 toCenter, vec3 edgeU, vec3 edgeV) {
    return dot(edgeU, edgeU) + dot(edgeV, edgeV) < 0.01f * dot(toCenter, toCenter);
}

// Fills in what follows from s.uv.
RT_FN void placeOnLight(RT_INOUT(LightSample) s, RT_IN(Light) light, vec3 position) {
    s.point = light.position + light.edgeU * s.uv.x + light.edgeV * s.uv.y;
    vec3 v = s.point - position;
    s.distance = length(v);
    s.wi = v * (1.0f / s.distance);
    s.normal = light.normal;
}

// Coordinates of p, relative to the corner and in the light's plane, in the basis of the edges.
RT_FN vec2 edgeCoordinates(RT_IN(Light) light, vec3 p) {
    vec3 n = cross(light.edgeU, light.edgeV);
    return vec2(dot(cross(p, light.edgeV), n), dot(cross(light.edgeU, p), n)) * (1.0f / dot(n, n));
}

// Fills in what follows from s.wi, a direction that meets the light's plane.
RT_FN void projectToLight(RT_INOUT(LightSample) s, RT_IN(Light) light, vec3 corner, vec3 position) {
    s.distance = dot(corner, light.normal) / dot(s.wi, light.normal);
    s.point = position + s.wi * s.distance;
    s.normal = light.normal;
    s.uv = edgeCoordinates(light, s.wi * s.distance - corner);
}

RT_FN LightSample sampleFlatProjected(RT_IN(Light) light, vec3 corner, vec3 position, vec3 normal, vec2 u) {
    LightSample s = noLightSample();
    vec3 drawn = sampleProjectedFlat(light, corner, normal, u);
    if (!(drawn.z > 0.0f)) return s;
    s.uv = vec2(drawn.x, drawn.y);
    placeOnLight(s, light, position);
    s.pdf = drawn.z * max(dot(normal, s.wi), 0.0f);
    return s;
}

RT_FN float flatProjectedPdf(RT_IN(Light) light, vec3 corner, vec3 normal, vec3 wi) {
    return projectedFlatDensity(light, corner, normal) * max(dot(normal, wi), 0.0f);
}

RT_SHARED_END

#endif
