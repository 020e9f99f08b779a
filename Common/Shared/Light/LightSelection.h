// Which light a vertex samples, and with what probability.
#ifndef RT_SHARED_LIGHT_SELECTION_H
#define RT_SHARED_LIGHT_SELECTION_H
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Base/Random.h"
#include "Common/Shared/Base/SceneAccess.h"
#include "Common/Shared/Light/LightContribution.h"
#include "Common/Shared/Light/LightTree.h"

RT_SHARED_BEGIN

// A table that `contribution` does not weigh light by light.
RT_FN bool usesLightTree(uint features, uint count) {
    return has(features, kFeatureManyLights) && count > kContributionLights;
}

RT_FN LightChoice chooseByPower(SceneRef scene, uint count, float u) {
    uint low = 0u;
    uint high = count - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (loadLight(scene, middle).cdf > u) {
            high = middle;
        } else {
            low = middle + 1u;
        }
    }
    RT_IN(Light) light = loadLight(scene, low);
    LightChoice choice;
    choice.light = light.selection > 0.0f ? low : kNone;
    choice.probability = light.selection;
    choice.u = light.selection > 0.0f ? stretch(u, light.cdf - light.selection, light.cdf) : 0.0f;
    return choice;
}

RT_FN LightChoice chooseUniformly(uint count, float u) {
    LightChoice choice;
    choice.light = min(uint(u * float(count)), count - 1u);
    choice.probability = 1.0f / float(count);
    choice.u = stretch(u, float(choice.light) / float(count), float(choice.light + 1u) / float(count));
    return choice;
}

#ifndef RT_PICKS_CONTRIBUTIONS
// The share u of the way along the contributions of `count` lights, at least one.
RT_FN LightPick pickContribution(SceneRef scene, uint count, vec3 position, vec3 normal, float u) {
    LightWeights weights;
    LightWeights sums;
    LightPick pick;
    pick.total = 0.0f;
    for (uint i = 0u; i < count; i++) {
        weights.weight[i] = lightContribution(loadLightBound(scene, i), position, normal);
        pick.total += weights.weight[i];
        sums.weight[i] = pick.total;
    }
    float place = u * pick.total;
    uint passed = 0u;
    for (uint i = 0u; i < count; i++) passed += sums.weight[i] <= place ? 1u : 0u;
    pick.light = min(passed, count - 1u);
    pick.weight = weights.weight[pick.light];
    pick.beyond = sums.weight[pick.light] - place;
    return pick;
}
#endif

RT_FN LightChoice noLightChoice() {
    LightChoice choice;
    choice.light = kNone;
    choice.probability = 0.0f;
    choice.u = 0.0f;
    return choice;
}

RT_FN LightChoice choiceOf(RT_IN(LightPick) pick) {
    LightChoice choice = noLightChoice();
    // All weights are 0 or, as rarely as a sum is rounded, one between others was met.
    if (!(pick.weight > 0.0f)) return choice;
    choice.light = pick.light;
    choice.probability = pick.weight / pick.total;
    choice.u = clamp(1.0f - pick.beyond / pick.weight, 0.0f, 0.999999940395355f);
    return choice;
}

// In proportion to the contributions of a short table.
RT_FN LightChoice chooseByContribution(SceneRef scene, uint count, float u, RT_INOUT(LightContext) context) {
    if (count == 0u) return noLightChoice();
    LightPick pick = pickContribution(scene, count, context.position, context.normal, u);
    context.total = pick.total;
    return choiceOf(pick);
}

// Chooses among the lights proper by u.x, or in a tree by both numbers, and completes `context` with what
// lightProbability needs.
RT_FN LightChoice chooseLight(uint features, SceneRef scene, uint count, vec2 u, RT_INOUT(LightContext) context) {
    context.total = 0.0f;
    if (count > 0u && context.policy == kSelectPower) return chooseByPower(scene, count, u.x);
    if (count > 0u && context.policy == kSelectUniform) return chooseUniformly(count, u.x);
    if (!usesLightTree(features, count)) return chooseByContribution(scene, count, u.x, context);
    TreeChoice drawn = chooseFromTree(scene, u, context.position, context.normal);
    context.total = drawn.total;
    LightChoice choice;
    choice.light = drawn.light;
    choice.probability = drawn.probability;
    choice.u = 0.0f;
    return choice;
}

// Probability with which chooseLight picks `light` in this context.
RT_FN float lightProbability(uint features, SceneRef scene, uint count, uint light, RT_IN(LightContext) context) {
    if (context.policy == kSelectPower) return loadLight(scene, light).selection;
    if (context.policy == kSelectUniform) return 1.0f / float(count);
    if (!(context.total > 0.0f)) return 0.0f;
    if (usesLightTree(features, count)) return treeProbability(scene, light, context.position, context.normal);
    return lightContribution(loadLightBound(scene, light), context.position, context.normal) / context.total;
}

RT_SHARED_END

#endif
