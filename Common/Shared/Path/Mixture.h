// Shirley's mixture of directions towards lights and targets with those of the bsdf.
#ifndef RT_SHARED_MIXTURE_H
#define RT_SHARED_MIXTURE_H
#include "Common/Shared/Light/LightDensity.h"
#include "Common/Shared/Path/DirectLight.h"

RT_SHARED_BEGIN

// Whether the direction in which v scatters is drawn from the mixture.
RT_FN bool usesMixture(Features features, RT_IN(RenderParams) params, RT_IN(SceneGlobals) globals, RT_IN(Vertex) v) {
    return has(features, kMethodMixture) && params.lightSampling == kSampleMixture &&
           globals.lightCount + globals.targetCount > 0u && !isDeltaVertex(features, v);
}

// Share of the importance targets among all that the mixture's half for lights chooses from.
RT_FN float targetShare(RT_IN(SceneGlobals) globals) {
    return float(globals.targetCount) / float(globals.lightCount + globals.targetCount);
}

// The sample that chooses among the lights proper: of the mixture's what is left of it behind the choice between targets
// and lights, whichever it was. (A light is chosen even when a target is sampled: the density of the direction sums over
// all of them, and punctual lights, which no direction hits, are sampled beside.)
RT_FN vec2 lightSelectionSample(Features features, RT_IN(RenderParams) params, RT_IN(SceneGlobals) globals,
                                RT_IN(VertexSamples) u) {
    vec2 selection = selectionSample(features, globals, u);
    if (has(features, kMethodMixture) && params.lightSampling == kSampleMixture) {
        float share = targetShare(globals);
        selection.x =
            selection.x < share ? remapSample(selection.x, 0.0f, share) : remapSample(selection.x, share, 1.0f);
    }
    return selection;
}

// Probability of choosing entry i of lights and targets: targets share count / total, each the same.
RT_FN float mixtureProbability(Features features, SceneRef scene, RT_IN(RenderParams) params,
                               RT_IN(SceneGlobals) globals, uint i, RT_IN(LightContext) context) {
    float all = float(globals.lightCount + globals.targetCount);
    if (i >= globals.lightCount) return 1.0f / all;
    return float(globals.lightCount) / all *
           lightProbability(features, scene, params.lightSelection, globals.lightCount, i, context);
}

// Density over solid angle with which light sampling as a whole, occluded or not, proposes wi.
RT_FN float mixtureLightPdf(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(SceneGlobals) globals,
                            float time, vec3 wi, RT_IN(LightContext) context) {
    float sum = 0.0f;
    uint count = globals.lightCount + globals.targetCount;
    for (uint i = 0u; i < count; i++) {
        RT_IN(Light) light = loadLight(scene, i);
        float density = 0.0f;
        if (has(features, kFeatureSkyImage) && light.kind == kLightSky) {
            density = skyPdf(scene, wi);
        } else if (!isPunctual(features, light)) {
            density = lightPdfAlong(features, params, light, context.position, context.normal, time, wi);
        }
        if (density > 0.0f) sum += density * mixtureProbability(features, scene, params, globals, i, context);
    }
    return sum;
}

// The light or target that the mixture samples, given the light that was chosen.
RT_FN LightChoice mixtureChoice(Features features, RT_IN(SceneGlobals) globals, RT_IN(LightChoice) light,
                                RT_IN(VertexSamples) u) {
    LightChoice choice = light;
    float pick = selectionSample(features, globals, u).x;
    float share = targetShare(globals);
    if (pick < share) {
        float position = pick / share * float(globals.targetCount);
        uint target = min(uint(position), globals.targetCount - 1u);
        choice.light = globals.lightCount + target;
        choice.u = clamp(position - float(target), 0.0f, 0.999999940395355f);
    }
    return choice;
}

// Share of the bsdf in the mixture: half, and of the lights' half what falls to punctual lights, which no direction
// hits.
RT_FN float bsdfShare(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(SceneGlobals) globals,
                      RT_IN(LightContext) context) {
    float share = 0.5f;
    if (!has(features, kFeaturePunctualLights)) return share;
    for (uint i = 0u; i < globals.lightCount; i++) {
        if (!isPunctual(features, loadLight(scene, i))) continue;
        share += 0.5f * mixtureProbability(features, scene, params, globals, i, context);
    }
    return share;
}

// Whether a direction can be drawn for the choice, or the bsdf's is taken in its place.
RT_FN bool hasDirections(Features features, SceneRef scene, RT_IN(LightChoice) choice) {
    if (!has(features, kFeaturePunctualLights) || choice.light == kNone) return true;
    return !isPunctual(features, loadLight(scene, choice.light));
}

// Samples a direction to the light or target of mixtureChoice(); a pdf of 0 where there is none.
RT_FN LightSample sampleMixtureLight(Features features, SceneRef scene, RT_IN(RenderParams) params,
                                     RT_IN(SceneGlobals) globals, RT_IN(LightChoice) choice, RT_IN(Vertex) v,
                                     RT_IN(VertexSamples) u, float time) {
    if (choice.light == kNone) return noLightSample();
    vec2 position = positionSample(features, globals, choice, u);
    return sampleChosenLight(features, scene, params, loadLight(scene, choice.light), v, time, position);
}

// Replaces b, the bsdf's sample, by that of the one-sample mixture: half from the lights, half from the bsdf. `light`
// was chosen in this context by lightSelectionSample().
RT_FN BsdfSample sampleMixture(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(LightChoice) light,
                               RT_IN(Vertex) v, RT_IN(VertexSamples) u, RT_IN(BsdfSample) b, float time,
                               RT_IN(LightContext) context) {
    RT_IN(SceneGlobals) globals = loadGlobals(scene);
    // Where no light can contribute and there is no target, the lights' half of the mixture would be empty.
    bool lightless = params.lightSelection == kSelectContribution && !(context.total > 0.0f);
    if (lightless && globals.targetCount == 0u) return b;
    BsdfSample mixed = b;
    LightChoice choice = mixtureChoice(features, globals, light, u);
    bool aimsAtLight = u.roulette.y < 0.5f && hasDirections(features, scene, choice);
    float share = bsdfShare(features, scene, params, globals, context);
    if (!aimsAtLight && (b.delta != 0u || b.transmitted != 0u)) {
        // Lights have no part in a mirror's direction, and they are aimed at on the side of wo only.
        mixed.weight = b.weight * (1.0f / share);
        return mixed;
    }
    mixed.weight = vec3(0.0f, 0.0f, 0.0f);
    mixed.delta = 0u;
    mixed.transmitted = 0u;
    if (aimsAtLight) {
        LightSample sampled = sampleMixtureLight(features, scene, params, globals, choice, v, u, time);
        if (!(sampled.pdf > 0.0f)) return mixed;
        mixed.wi = sampled.wi;
    }
    vec4 f = evalScattering(features, v, mixed.wi);
    float pdf = share * f.w + 0.5f * mixtureLightPdf(features, scene, params, globals, time, mixed.wi, context);
    mixed.pdf = pdf;
    if (pdf > 0.0f) mixed.weight = vec3(f) / pdf;
    return mixed;
}

RT_SHARED_END

#endif
