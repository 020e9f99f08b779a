// Sampling of one light: a direction towards it, and the density of that direction given this light. sampleLight and
// lightPdf take every decision from the same function of the light and the shading point, never from the sample.
#ifndef RT_SHARED_LIGHTS_H
#define RT_SHARED_LIGHTS_H
#include "Common/Shared/Light/EllipsoidLight.h"
#include "Common/Shared/Light/LightShapes.h"
#include "Common/Shared/Light/QuadLight.h"
#include "Common/Shared/Light/SphereLight.h"
#include "Common/Shared/Light/TriangleLight.h"

RT_SHARED_BEGIN

// isSphereLight(features, light), and so on. Shapes that the scene lacks are false by `features` alone, which keeps them
// out of the code.
#define RT_IS_SHAPE(Name, kind_, bit, feature, isPlanar)            \
    RT_FN bool is##Name##Light(uint features, RT_IN(Light) light) { \
        return has(features, 1u << bit) && light.kind == kind_;     \
    }
RT_LIGHT_SHAPES(RT_IS_SHAPE)

// Whether a point lies on the side that a planar light illuminates.
RT_FN bool isLit(RT_IN(Light) light, vec3 position) {
    return light.sides == kSidesBoth || dot(light.normal, position - light.position) > 0.0f;
}

// Whether the light is planar, and the point on its dark side.
RT_FN bool isBehind(uint features, RT_IN(Light) light, vec3 position) {
#define RT_OR_IS_PLANAR(Name, kind_, bit, feature, isPlanar) || (isPlanar && is##Name##Light(features, light))
    return (false RT_LIGHT_SHAPES(RT_OR_IS_PLANAR)) && !isLit(light, position);
}

// A sample of `light` as its shape gave it, with what all shapes have in common, and the density 0 where it is useless.
RT_FN LightSample completeSample(RT_IN(Light) light, vec3 normal, RT_IN(LightSample) drawn) {
    LightSample s = drawn;
    s.radiance = light.emission;
    // Rounding may let the point coincide with the shading point, and the direction run within the light's plane, which
    // is then infinitely far, or behind.
    bool isAhead = s.distance > 0.0f && s.distance < kInfinity;
    if (!(s.pdf < kInfinity && isAhead && dot(s.wi, s.wi) < 2.0f)) s.pdf = 0.0f;
    if (isSurface(normal) && dot(normal, s.wi) <= 0.0f) s.pdf = 0.0f;
    return s;
}

// `normal` is the shading point's geometric normal on the side of wo, zero for a point in a medium. The sky is not
// sampled here (Sky.h).
RT_FN LightSample sampleLight(uint features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position, vec3 normal,
                              float time, vec2 u) {
    LightSample s = noLightSample();
    if (isBehind(features, light, position)) return s;
    vec3 corner = light.position - position;
    if (isFlatProjected(features, params, light, corner, normal)) {
        s = sampleFlatProjected(light, corner, position, normal, u);
    }
#define RT_SAMPLE(Name, kind_, bit, feature, isPlanar)                               \
    else if (is##Name##Light(features, light)) {                                     \
        s = sample##Name##Light(features, params, light, position, normal, time, u); \
    }
    RT_LIGHT_SHAPES(RT_SAMPLE)
    return completeSample(light, normal, s);
}

// Density of wi under sampleLight, for a direction that meets the light at `distance` under its geometric normal
// `lightNormal`.
RT_FN float lightPdf(uint features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position, vec3 normal,
                     float time, vec3 wi, float distance, vec3 lightNormal) {
    vec3 corner = light.position - position;
    if (isFlatProjected(features, params, light, corner, normal)) return flatProjectedPdf(light, corner, normal, wi);
#define RT_PDF(Name, kind_, bit, feature, isPlanar)                                                          \
    if (is##Name##Light(features, light)) {                                                                  \
        return pdf##Name##Light(features, params, light, position, normal, time, wi, distance, lightNormal); \
    }
    RT_LIGHT_SHAPES(RT_PDF)
    return 0.0f;
}

// Density over solid angle of wi under sampleLight, whatever stands in between: what a mixture sums over lights; 0 where
// wi misses the light.
RT_FN float lightPdfAlong(uint features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position, vec3 normal,
                          float time, vec3 wi) {
    if (isBehind(features, light, position)) return 0.0f;
    LightIntersection at;
    at.distance = 0.0f;
#define RT_INTERSECT(Name, kind_, bit, feature, isPlanar) \
    if (is##Name##Light(features, light)) at = intersect##Name##Light(light, position, time, wi);
    RT_LIGHT_SHAPES(RT_INTERSECT)
    if (!(at.distance > 0.0f)) return 0.0f;
    return lightPdf(features, params, light, position, normal, time, wi, at.distance, at.normal);
}

#undef RT_IS_SHAPE
#undef RT_OR_IS_PLANAR
#undef RT_SAMPLE
#undef RT_PDF
#undef RT_INTERSECT

RT_SHARED_END

#endif
