// Emission that the ray of a path hits, weighed against the light sampling of the vertex before.
#ifndef RT_SHARED_EMISSION_H
#define RT_SHARED_EMISSION_H
#include "Common/Shared/Light/LightSelection.h"
#include "Common/Shared/Light/Lights.h"
#include "Common/Shared/Light/Sky.h"
#include "Common/Shared/Shape/Surface.h"
#include "Common/Shared/Texture/Textures.h"

RT_SHARED_BEGIN

// In place of densities, up to the first vertex that is no mirror and no glass, see EdgeRays.h: of a path whose
// emission is counted apart, and of the rays that count it. And of such a path behind that vertex, a blurred mirror.
const float kCountedApart = -1.0f;
const float kEdgeRay = -2.0f;
const float kBlurCountedApart = -3.0f;
// And of a path that max depth has ended, though it would have gone on.
const float kCutOff = -4.0f;

RT_FN bool isBehindGlossyHit(Features features, RT_IN(PathState) s) {
    return has(features, kFeatureLights) && has(features, kFeatureFuzz) && s.pdf == kBlurCountedApart;
}

RT_FN bool isCountedApart(Features features, RT_IN(PathState) s) {
    return has(features, kFeatureLights) && (s.pdf == kCountedApart || isBehindGlossyHit(features, s));
}

RT_FN bool isEdgeRay(Features features, RT_IN(PathState) s) {
    return has(features, kFeatureLights) && s.pdf == kEdgeRay;
}

// Of a path that has been cut off: what it would have gone on with, the mean of the channels. Times what came `before`
// where throughput has begun anew.
RT_FN float cutOffThroughput(RT_IN(PathState) s, vec3 before) {
    vec3 throughput = s.throughput * before;
    return (throughput.x + throughput.y + throughput.z) * (1.0f / 3.0f);
}

RT_FN bool usesMis(RT_IN(RenderParams) params) {
    return params.lightSampling >= kSampleMis;
}

// Weight of emission that a bsdf-sampled ray hit, against next-event estimation with density lightDensity.
RT_FN float emissionWeight(RT_IN(RenderParams) params, float pdf, float lightDensity) {
    if (!usesMis(params) || pdf == 0.0f) return 1.0f;
    return params.lightSampling == kSampleMisBalance ? balanceHeuristic(pdf, lightDensity)
                                                     : powerHeuristic(pdf, lightDensity);
}

// `chainWeight`: against what else may have found it.
RT_FN void addSky(Features features, SceneRef scene, RT_IN(RenderParams) params, float chainWeight,
                  RT_INOUT(PathState) s) {
    if (!has(features, kFeatureSky) || isCountedApart(features, s)) return;
    float weight = chainWeight;
    if (has(features, kFeatureSkyImage)) {
        RT_IN(SceneGlobals) globals = loadGlobals(scene);
        if (globals.skyLight != kNone && usesMis(params) && s.pdf > 0.0f) {
            float probability = lightProbability(features, scene, globals.lightCount, globals.skyLight, s.last);
            weight = emissionWeight(params, s.pdf, probability * skyPdf(scene, s.ray.direction));
        }
    }
    s.radiance += s.throughput * skyRadiance(features, scene, s.ray.direction) * weight;
}

// Emitted radiance at a point of a surface with this material, both sides alike.
RT_FN vec3 emittedRadiance(Features features, SceneRef scene, RT_IN(Material) material, vec3 position, vec2 uv,
                           vec2 uv2) {
    if (material.emissionTexture == kNone) return material.emission;
    return material.emission *
           vec3(evalTexture(features, scene, material.emissionTexture, position + loadGlobals(scene).origin, uv, uv2));
}

// `chainWeight`: against what else may have found it.
RT_FN void addEmission(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(Surface) surface,
                       RT_IN(Material) material, float distance, float chainWeight, RT_INOUT(PathState) s) {
    if (!has(features, kFeatureEmissive) || maxComponent(material.emission) == 0.0f) return;
    bool front = dot(s.ray.direction, surface.normal) < 0.0f;
    if ((!front && material.emissionSides != kSidesBoth) || isCountedApart(features, s)) return;
    vec3 emitted = emittedRadiance(features, scene, material, surface.position, surface.uv, surface.uv2);
    float weight = chainWeight;
    if (has(features, kFeatureLights) && surface.light != kNone && usesMis(params) && s.pdf > 0.0f) {
        float probability = lightProbability(features, scene, loadGlobals(scene).lightCount, surface.light, s.last);
        float density = lightPdf(features, params, loadLight(scene, surface.light), s.last.position, s.last.normal,
                                 s.ray.time, s.ray.direction, distance, surface.normal);
        weight = emissionWeight(params, s.pdf, probability * density);
    }
    s.radiance += s.throughput * emitted * weight;
}

RT_SHARED_END

#endif
