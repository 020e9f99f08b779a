// Which light a vertex samples, and with what probability.
#ifndef RT_SHARED_LIGHT_SELECTION_H
#define RT_SHARED_LIGHT_SELECTION_H
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Base/PathTypes.h"
#include "Common/Shared/Base/Random.h"
#include "Common/Shared/Base/SceneAccess.h"
#include "Common/Shared/Light/LightContribution.h"
#include "Common/Shared/Light/LightTree.h"

RT_SHARED_BEGIN

// A table that `contribution` does not weigh light by light.
RT_FN bool usesLightTree(Features features, uint count) {
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
    choice.u = light.selection > 0.0f ? remapSample(u, light.cdf - light.selection, light.cdf) : 0.0f;
    return choice;
}

RT_FN LightChoice chooseUniformly(uint count, float u) {
    LightChoice choice;
    choice.light = min(uint(u * float(count)), count - 1u);
    choice.probability = 1.0f / float(count);
    choice.u = remapSample(u, float(choice.light) / float(count), float(choice.light + 1u) / float(count));
    return choice;
}

const uint kSumGroup = 8u; // divides kContributionLights

struct GroupWeights {
    float at[kSumGroup];
};

// Element k: the sum of `before` and the weights 0 to k of a group, by chains of few additions.
RT_FN GroupWeights runningSums(RT_IN(GroupWeights) weights, float before) {
    GroupWeights sums;
    for (uint k = 0u; k < kSumGroup; k += 4u) {
        sums.at[k] = weights.at[k];
        sums.at[k + 1u] = weights.at[k + 1u] + weights.at[k];
        sums.at[k + 2u] = (weights.at[k + 2u] + weights.at[k + 1u]) + weights.at[k];
        sums.at[k + 3u] = (weights.at[k + 3u] + weights.at[k + 2u]) + sums.at[k + 1u];
    }
    float lowerHalf = sums.at[3];
    for (uint k = 0u; k < 4u; k++) {
        sums.at[k] = sums.at[k] + before;
        sums.at[k + 4u] = (sums.at[k + 4u] + lowerHalf) + before;
    }
    return sums;
}

// The light at the share u of the way along the contributions of `count` lights, at least one.
RT_FN LightPick pickContribution(SceneRef scene, uint count, vec3 position, vec3 normal, float u) {
    LightWeights weights;
    LightWeights sums;
    LightPick pick;
    pick.total = 0.0f;
    for (uint first = 0u; first < count; first += kSumGroup) {
        GroupWeights group;
        for (uint k = 0u; k < kSumGroup; k++) {
            group.at[k] = 0.0f;
            if (first + k < count) {
                group.at[k] = lightContribution(loadLightBound(scene, first + k), position, normal);
            }
            weights.weight[first + k] = group.at[k];
        }
        group = runningSums(group, pick.total);
        for (uint k = 0u; k < kSumGroup; k++) sums.weight[first + k] = group.at[k];
        pick.total = group.at[kSumGroup - 1u];
    }
    // The first light whose sum is beyond the target.
    float target = u * pick.total;
    pick.light = count - 1u;
    for (uint i = count - 1u; i > 0u; i--) pick.light = target < sums.weight[i - 1u] ? i - 1u : pick.light;
    pick.weight = weights.weight[pick.light];
    pick.beyond = sums.weight[pick.light] - target;
    return pick;
}

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

// Of a light from the tree; the descent used up both coordinates of the sample.
RT_FN LightChoice choiceOf(RT_IN(TreeChoice) drawn) {
    LightChoice choice;
    choice.light = drawn.light;
    choice.probability = drawn.probability;
    choice.u = 0.0f;
    return choice;
}

// In proportion to the contributions of a short table, not empty.
RT_FN LightChoice chooseByContribution(SceneRef scene, uint count, float u, RT_INOUT(LightContext) context) {
    LightPick pick = pickContribution(scene, count, context.position, context.normal, u);
    context.total = pick.total;
    return choiceOf(pick);
}

// Chooses among the lights proper by u.x, or in a tree by both coordinates, and completes `context` with what
// lightProbability needs. `policy`: kSelect...
RT_FN LightChoice chooseLight(Features features, SceneRef scene, uint policy, uint count, vec2 u,
                              RT_INOUT(LightContext) context) {
    context.total = 0.0f;
    if (count == 0u) return noLightChoice();
    if (policy == kSelectPower) return chooseByPower(scene, count, u.x);
    if (policy == kSelectUniform) return chooseUniformly(count, u.x);
    if (!usesLightTree(features, count)) return chooseByContribution(scene, count, u.x, context);
    TreeChoice drawn = chooseFromTree(scene, u, context.position, context.normal);
    context.total = drawn.total;
    return choiceOf(drawn);
}

// Probability with which chooseLight picks `light` in this context.
RT_FN float lightProbability(Features features, SceneRef scene, uint policy, uint count, uint light,
                             RT_IN(LightContext) context) {
    if (policy == kSelectPower) return loadLight(scene, light).selection;
    if (policy == kSelectUniform) return 1.0f / float(count);
    if (!(context.total > 0.0f)) return 0.0f;
    if (usesLightTree(features, count)) return treeProbability(scene, light, context.position, context.normal);
    return lightContribution(loadLightBound(scene, light), context.position, context.normal) / context.total;
}

RT_SHARED_END

#endif
