// Which light a vertex samples, and with what probability.
// The includer provides SceneRef, loadGlobals, loadLight and
//   LightWeights loadContributions(scene, position, normal): lightContribution() of each light of a table of at most
//   kContributionLights; the remaining weights are zero;
// and what LightTree.h names, for longer tables.
#ifndef RT_SHARED_LIGHT_SELECTION_H
#define RT_SHARED_LIGHT_SELECTION_H
#include "Features.h"
#include "LightTree.h"
#include "Lights.h"
#include "Random.h"

RT_SHARED_BEGIN

struct LightChoice {
    uint light;        // kNone: nothing to choose
    float probability; // > 0 otherwise
    float u;           // the number that chose, stretched to [0,1) for further use
};

// Added to `features` by those who have completed the context and made the choice before: it is LightContext::chosen.
const uint kLightChosen = 1u << kFeatureBits;

// Where lights are seen from. The point and the normal (zero in a medium) that selection and sampling used must also be
// those that a density is asked for, or the weights of multiple importance sampling would not sum to one.
struct LightContext {
    vec3 position;
    vec3 normal;
    float total;        // sum of contributions where selection is by contribution; 0: no light can contribute
    uint policy;        // the selection in force: kSelect...
    LightChoice chosen; // with kLightChosen, else undefined
};

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
    Light light = loadLight(scene, low);
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

// In proportion to the contributions of a short table.
RT_FN LightChoice chooseByContribution(SceneRef scene, uint count, float u, RT_INOUT(LightContext) context) {
    LightChoice choice;
    choice.light = kNone;
    choice.probability = 0.0f;
    choice.u = 0.0f;
    // Sums of the weights before each light; the choice is the last light of any weight whose sum is not above the target.
    LightWeights weights = loadContributions(scene, context.position, context.normal);
    LightWeights before;
    float total = 0.0f;
    for (uint i = 0u; i < count; i++) {
        before.weight[i] = total;
        total += weights.weight[i];
    }
    context.total = total;
    if (!(total > 0.0f)) return choice;
    float target = u * total;
    uint chosen = 0u;
    for (uint i = 0u; i < count; i++) {
        bool fits = before.weight[i] <= target && weights.weight[i] > 0.0f;
        chosen = max(chosen, fits ? i : 0u);
    }
    choice.light = chosen;
    choice.probability = weights.weight[chosen] / total;
    choice.u = clamp((target - before.weight[chosen]) / weights.weight[chosen], 0.0f, 0.999999940395355f);
    return choice;
}

// Chooses among the lights proper by u.x, or in a tree by both numbers, and completes `context` with what
// lightProbability needs.
RT_FN LightChoice chooseLight(uint features, SceneRef scene, uint count, vec2 u, RT_INOUT(LightContext) context) {
    if (has(features, kLightChosen)) return context.chosen;
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
