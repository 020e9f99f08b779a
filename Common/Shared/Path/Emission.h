// Emission that the ray of a path hits, weighed against the light sampling of the vertex before.
#ifndef RT_SHARED_EMISSION_H
#define RT_SHARED_EMISSION_H
#include "Common/Shared/Light/LightSelection.h"
#include "Common/Shared/Light/Lights.h"
#include "Common/Shared/Light/Sky.h"
#include "Common/Shared/Material/PrincipledSurface.h"
#include "Common/Shared/Shape/Surface.h"
#include "Common/Shared/Texture/Textures.h"

RT_SHARED_BEGIN

RT_FN bool usesMis(RT_IN(RenderParams) params) {
    return params.lightSampling >= kSampleMis;
}

// Weight of emission that a bsdf-sampled ray hit, against next-event estimation with density lightDensity.
RT_FN float emissionWeight(RT_IN(RenderParams) params, float pdf, float lightDensity) {
    if (!usesMis(params) || pdf == 0.0f) return 1.0f;
    return params.lightSampling == kSampleMisBalance ? balanceHeuristic(pdf, lightDensity)
                                                     : powerHeuristic(pdf, lightDensity);
}

// `share`: of the sky's light that is left to the path, see techniqueSkyShare().
RT_FN void addSky(Features features, SceneRef scene, RT_IN(RenderParams) params, float share, RT_INOUT(PathState) s) {
    if (!has(features, kFeatureSky) || share == 0.0f) return;
    float weight = share;
    if (has(features, kFeatureSkyImage)) {
        RT_IN(SceneGlobals) globals = loadGlobals(scene);
        if (globals.skyLight != kNone && usesMis(params) && s.pdf > 0.0f) {
            float probability =
                lightProbability(features, scene, params.lightSelection, globals.lightCount, globals.skyLight, s.last);
            weight *= emissionWeight(params, s.pdf, probability * skyPdf(scene, s.ray.direction));
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

// Emitted radiance where a ray meets the surface, with vertex colours if they count.
RT_FN vec3 surfaceEmission(Features features, SceneRef scene, RT_IN(Material) material, RT_IN(Surface) s) {
    vec3 emitted = emittedRadiance(features, scene, material, s.position, s.uv, s.uv2);
    if (!has(features, kFeatureVertexAttributes) || !isPrincipled(features, material)) return emitted;
    if (loadPrincipled(scene, s.material).emitsColors == 0u) return emitted;
    return emitted * vec3(s.color);
}

// `share`: of the emission that is left to the path, see techniqueEmissionShare().
RT_FN void addEmission(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(Surface) surface,
                       RT_IN(Material) material, float distance, float share, RT_INOUT(PathState) s) {
    if (!has(features, kFeatureEmissive) || maxComponent(material.emission) == 0.0f) return;
    bool front = dot(s.ray.direction, surface.normal) < 0.0f;
    if ((!front && material.emissionSides != kSidesBoth) || share == 0.0f) return;
    vec3 emitted = surfaceEmission(features, scene, material, surface);
    float weight = share;
    if (has(features, kFeatureLights) && surface.light != kNone && usesMis(params) && s.pdf > 0.0f) {
        float probability = lightProbability(features, scene, params.lightSelection, loadGlobals(scene).lightCount,
                                             surface.light, s.last);
        float density = lightPdf(features, params, loadLight(scene, surface.light), s.last.position, s.last.normal,
                                 s.ray.time, s.ray.direction, distance, surface.normal);
        weight *= emissionWeight(params, s.pdf, probability * density);
    }
    s.radiance += s.throughput * emitted * weight;
}

RT_SHARED_END

#endif
