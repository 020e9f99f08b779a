// The two questions of a path tracer: what does a ray hit first, and does anything lie between two points. Header-only
// with internal linkage, so that a kernel inlines it for its own instruction set. No recursion, no allocation, no
// virtual call.
//
// `features` is a constant where these are called; primitives of kinds that it lacks cost nothing, and must not exist
// in the scene. Rays start off their surface (every t > 0 counts); their direction has unit length in world space.
//
// Of hits at exactly the same t the one with the lowest (instance, kind, primitive) is reported, the world's own
// geometry before all instances; so the answer depends neither on the tree nor on the order of traversal.
#pragma once
#include "Common/Accel/Traverse/TraverseLinear.h"
#include "Common/Accel/Traverse/TraverseTree.h"

namespace rt::accel {
namespace {

// The nearest hit with 0 < t < tMax; its t is negative if there is none.
RT_FN shared::Hit traceClosest(shared::Features features, const AccelView& view, const shared::Ray& ray, float tMax) {
    if (view.isLinear) return traceLinear(features, view, makeShapeRay(features, ray, true), tMax);
    shared::Hit best{tMax, 0, 0, shared::kNone, 0.0f, 0.0f};
    if (view.quantizedNodes != nullptr) {
        const LeafRay leafRay = makeLeafRay(features, ray, true);
        visitQuantized(view, ray, best.t, [&](Reference leaf) {
            traceLeaf<false, true>(features, view, leaf, leafRay, shared::kNone, best);
            return false;
        });
    } else if (view.isLarge) {
        traceTree<true, true>(features, view, view.root, ray, shared::kNone, best);
    } else {
        traceTree<true, false>(features, view, view.root, ray, shared::kNone, best);
    }
    if (!(best.t < tMax)) best.t = -1.0f;
    return best;
}

// Whether anything is hit with 0 < t < tMax.
RT_FN bool occluded(shared::Features features, const AccelView& view, const shared::Ray& ray, float tMax) {
    if (view.isLinear) return occludedLinear(features, view, makeShapeRay(features, ray, true), tMax);
    if (view.quantizedNodes != nullptr) {
        const LeafRay leafRay = makeLeafRay(features, ray, true);
        bool isHit = false;
        visitQuantized(view, ray, tMax, [&](Reference leaf) {
            isHit = occludedLeaf<false, true>(features, view, leaf, leafRay, tMax);
            return isHit;
        });
        return isHit;
    }
    return view.isLarge ? occludedTree<true, true>(features, view, view.root, ray, tMax)
                        : occludedTree<true, false>(features, view, view.root, ray, tMax);
}

} // namespace
} // namespace rt::accel
