// Choice among many lights: descent through a tree of bounds, after the importance sampling of Conty Estevez & Kulla,
// "Importance Sampling of Many Lights with Adaptive Tree Splitting", 2018, with eight children a node and estimates of
// means where they use upper bounds.
#ifndef RT_SHARED_LIGHT_TREE_H
#define RT_SHARED_LIGHT_TREE_H
#include "Common/Shared/Base/Random.h"
#include "Common/Shared/Base/SceneAccess.h"
#include "Common/Shared/Light/LightClusters.h"

RT_SHARED_BEGIN

// Of all children of a node.
RT_FN ClusterWeights loadClusterWeights(SceneRef scene, uint node, vec3 position, vec3 normal) {
    ClusterWeights w;
    for (uint i = 0u; i < kLightNodeChildren; i++)
        w.weight[i] = clusterContribution(loadLightCluster(scene, node, i), position, normal);
    return w;
}

// [i]: of the weights before child i; [kLightNodeChildren]: of all. Added up in such an order that the sums never fall,
// that a child without weight adds nothing, and that the last does not wait for all others.
struct ClusterSums {
    float before[kLightNodeChildren + 1u];
};

RT_FN ClusterSums sumsOf(RT_IN(ClusterWeights) w) {
    ClusterSums s;
    float pair0 = w.weight[0] + w.weight[1];
    float pair1 = w.weight[2] + w.weight[3];
    float pair2 = w.weight[4] + w.weight[5];
    float pair3 = w.weight[6] + w.weight[7];
    float low = pair0 + pair1;
    s.before[0] = 0.0f;
    s.before[1] = w.weight[0];
    s.before[2] = pair0;
    s.before[3] = pair0 + w.weight[2];
    s.before[4] = low;
    s.before[5] = low + w.weight[4];
    s.before[6] = low + pair2;
    s.before[7] = low + (pair2 + w.weight[6]);
    s.before[8] = low + (pair2 + pair3);
    return s;
}

// A light drawn from the tree.
struct TreeChoice {
    uint light; // kNone: the descent ended where no light can contribute
    float probability;
    float total; // weight of the root: 0 where no light at all can contribute
};

// On the way from the root to a light. Uses the coordinates of a 2D sample one after the other: each is stretched by
// choices until a thousandth is left of it, then the next one serves; after both, hashes of them.
struct TreeDescent {
    uint child; // as in LightNode; kNone: it has ended where no light can contribute
    float probability;
    float total; // as in TreeChoice
    float u;
    float left;
    uint used; // coordinates of `selection`
    vec2 selection;
};

RT_FN TreeDescent beginDescent(vec2 selection) {
    TreeDescent d;
    d.child = 0u;
    d.probability = 1.0f;
    d.total = 0.0f;
    d.u = selection.x;
    d.left = 1.0f;
    d.used = 0u;
    d.selection = selection;
    return d;
}

RT_FN bool isAtNode(RT_IN(TreeDescent) d) {
    return (d.child & kLightLeaf) == 0u;
}

// From a node to one of its children.
RT_FN void descend(SceneRef scene, vec3 position, vec3 normal, RT_INOUT(TreeDescent) d) {
    uint node = d.child;
    ClusterWeights w = loadClusterWeights(scene, node, position, normal);
    ClusterSums sums = sumsOf(w);
    float total = sums.before[kLightNodeChildren];
    if (node == 0u) d.total = total;
    d.child = kNone;
    if (!(total > 0.0f)) return;
    // The last child whose sum is not above the target: one of some weight, since the target is below the total.
    float target = d.u * total;
    uint chosen = 0u;
    for (uint i = 1u; i < kLightNodeChildren; i++) chosen += sums.before[i] <= target ? 1u : 0u;
    d.child = loadLightCluster(scene, node, chosen).child;
    float share = w.weight[chosen] / total;
    d.probability *= share;
    d.u = clamp((target - sums.before[chosen]) / w.weight[chosen], 0.0f, 0.999999940395355f);
    d.left *= share;
    if (d.left < 1.0e-3f) {
        d.used++;
        d.left = 1.0f;
        d.u = d.selection.y;
        if (d.used > 1u)
            d.u = toUniform(hash3(uvec3(floatBitsToUint(d.selection.x), floatBitsToUint(d.selection.y), d.used)).x);
    }
}

RT_FN TreeChoice endDescent(RT_IN(TreeDescent) d) {
    TreeChoice choice;
    choice.light = d.child == kNone ? kNone : d.child & ~kLightLeaf;
    choice.probability = d.probability;
    choice.total = d.total;
    return choice;
}

RT_CALL TreeChoice chooseFromTree(SceneRef scene, vec2 selection, vec3 position, vec3 normal) {
    TreeDescent d = beginDescent(selection);
    while (isAtNode(d)) descend(scene, position, normal, d);
    return endDescent(d);
}

// Probability with which chooseFromTree draws `light`: the product of the shares on the way from it to the root.
RT_CALL float treeProbability(SceneRef scene, uint light, vec3 position, vec3 normal) {
    float probability = 1.0f;
    uint place = loadLightLeaf(scene, light);
    if (place == kNone) return 0.0f;
    while (place != kNone) {
        uint node = place / kLightNodeChildren;
        ClusterWeights w = loadClusterWeights(scene, node, position, normal);
        float own = w.weight[place % kLightNodeChildren];
        if (!(own > 0.0f)) return 0.0f;
        probability *= own / sumsOf(w).before[kLightNodeChildren];
        place = loadLightNodeParent(scene, node);
    }
    return probability;
}

RT_SHARED_END

#endif
