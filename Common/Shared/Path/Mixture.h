// Shirley's mixture of directions towards lights and targets with those of the bsdf.
#ifndef RT_SHARED_MIXTURE_H
#define RT_SHARED_MIXTURE_H
#include "Common/Shared/Light/LightDensity.h"
#include "Common/Shared/Path/DirectLight.h"

RT_SHARED_BEGIN

// Probability of choosing entry i of lights and targets: targets share count / total, each the same.
RT_FN float mixtureProbability(uint features, SceneRef scene, RT_IN(SceneGlobals) globals, uint i,
                               RT_IN(LightContext) context) {
    float all = float(globals.lightCount + globals.targetCount);
    if (i >= globals.lightCount) return 1.0f / all;
    return float(globals.lightCount) / all * lightProbability(features, scene, globals.lightCount, i, context);
}

// Density over solid angle with which light sampling as a whole, occluded or not, proposes wi.
RT_FN float mixtureLightPdf(uint features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(SceneGlobals) globals,
                            float time, vec3 wi, RT_IN(LightContext) context) {
    float sum = 0.0f;
    uint count = globals.lightCount + globals.targetCount;
    for (uint i = 0u; i < count; i++) {
        RT_IN(Light) light = loadLight(scene, i);
        float density = 0.0f;
        if (has(features, kFeatureSkyImage) && light.kind == kLightSky) {
            density = skyPdf(scene, wi);
        } else {
            density = lightPdfAlong(features, params, light, context.position, context.normal, time, wi);
        }
        if (density > 0.0f) sum += density * mixtureProbability(features, scene, globals, i, context);
    }
    return sum;
}

// Chooses a light or a target and a direction to it; a pdf of 0 where there is none.
RT_FN LightSample sampleMixtureLight(uint features, SceneRef scene, RT_IN(RenderParams) params,
                                     RT_IN(SceneGlobals) globals, RT_IN(Sampler) smp, RT_IN(Vertex) v, float time,
                                     RT_INOUT(LightContext) context) {
    vec2 pick = selectionNumbers(features, globals, smp, v);
    float split = float(globals.targetCount) / float(globals.lightCount + globals.targetCount);
    // The context is completed even when a target is chosen: the density of the direction sums over all of them.
    vec2 rest = vec2(stretch(pick.x, split, 1.0f), pick.y);
    LightChoice choice = chooseLight(features, scene, globals.lightCount, rest, context);
    if (pick.x < split) {
        float position = pick.x / split * float(globals.targetCount);
        uint target = min(uint(position), globals.targetCount - 1u);
        choice.light = globals.lightCount + target;
        choice.u = clamp(position - float(target), 0.0f, 0.999999940395355f);
    }
    if (choice.light == kNone) return noLightSample();
    vec2 u = sampleNumbers(features, globals, choice, v);
    return sampleChosenLight(features, scene, params, loadLight(scene, choice.light), v, time, u);
}

// Replaces the bsdf's direction by that of the one-sample mixture: half from the lights, half from the bsdf.
RT_FN BsdfSample sampleMixture(uint features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(Sampler) smp,
                               RT_IN(Vertex) v, RT_IN(BsdfSample) b, float time, RT_INOUT(LightContext) context) {
    RT_IN(SceneGlobals) globals = loadGlobals(scene);
    if (globals.lightCount + globals.targetCount == 0u) return b;
    LightSample sampled = sampleMixtureLight(features, scene, params, globals, smp, v, time, context);
    // Where no light can contribute and there is no target, the lights' half of the mixture would be empty.
    bool lightless = context.policy == kSelectContribution && !(context.total > 0.0f);
    if (lightless && globals.targetCount == 0u) return b;
    BsdfSample mixed = b;
    mixed.weight = vec3(0.0f, 0.0f, 0.0f);
    if (v.numbers.choice.y < 0.5f) {
        if (!(sampled.pdf > 0.0f)) return mixed;
        mixed.wi = sampled.wi;
    }
    vec4 f = evalScattering(features, v, mixed.wi);
    float pdf = 0.5f * f.w + 0.5f * mixtureLightPdf(features, scene, params, globals, time, mixed.wi, context);
    mixed.pdf = pdf;
    if (pdf > 0.0f) mixed.weight = vec3(f) / pdf;
    return mixed;
}

RT_SHARED_END

#endif
