// Scenes without a tree: a few blocks, all of which every ray meets.
#pragma once
#include "Common/Accel/AccelView.h"
#include "Common/Accel/ShapeBlocks.h"
#include "Common/Accel/Simd/Simd.h"
#include "Common/Shared/Base/Features.h"

namespace rt::accel {
namespace {

// The nearest hit in each lane, over all blocks so far.
struct FlatBest {
    Float8 t, u, v;
    Index8 name;
};

RT_FN FlatBest noFlatHit(float tMax) {
    const Float8 zero = broadcast(0.0f);
    const FlatBest best{broadcast(tMax), zero, zero, {}};
    return best;
}

RT_FN void acceptFlat(const LaneHits& lanes, const std::uint32_t* names, FlatBest& best) {
    const Mask8 nearer = lanes.mask & (lanes.t < best.t);
    best.t = select(nearer, lanes.t, best.t);
    best.u = select(nearer, lanes.u, best.u);
    best.v = select(nearer, lanes.v, best.v);
    best.name = select(nearer, loadIndex(names), best.name);
}

RT_FN shared::Hit nearestFlat(const FlatBest& best, float tMax) {
    shared::Hit hit{-1.0f, 0, 0, shared::kNone, 0.0f, 0.0f};
    const float t = least(best.t);
    if (!(t < tMax)) return hit;
    const Mask8 nearest = best.t == broadcast(t);
    std::uint32_t name = firstOf(nearest, best.name);
    hit.t = t;
    hit.u = firstOf(nearest, best.u);
    hit.v = firstOf(nearest, best.v);
    const unsigned lanes = bits(nearest);
    for (unsigned others = lanes & (lanes - 1); others != 0; others &= others - 1) { // a tie
        const unsigned i = lowestBit(others);
        const std::uint32_t other = lane(best.name, i);
        if (other > name) continue;
        name = other;
        hit.u = lane(best.u, i);
        hit.v = lane(best.v, i);
    }
    hit.kind = name >> kFlatKindShift;
    hit.primitive = name & ((1u << kFlatKindShift) - 1);
    return hit;
}

template <class Block, class Test>
RT_FN void eachFlatBlock(const FlatList<Block>& list, const Test& test) {
    for (const Block* block = list.blocks; block != list.blocks + list.count; ++block) test(*block);
}

// Calls test(block) for every block of the scene.
template <class Test>
RT_FN void eachFlatBlock(shared::uint features, const AccelView& view, const Test& test) {
    if (shared::has(features, shared::kFeatureSpheres)) eachFlatBlock(view.flatSpheres, test);
    if (shared::has(features, shared::kFeatureMovingSpheres)) eachFlatBlock(view.flatMovingSpheres, test);
    if (shared::has(features, shared::kFeatureQuads)) eachFlatBlock(view.flatQuads, test);
    if (shared::has(features, shared::kFeatureTriangles)) eachFlatBlock(view.flatTriangles, test);
}

RT_FN shared::Hit traceFlat(shared::uint features, const AccelView& view, const ShapeRay& ray, float tMax) {
    FlatBest best = noFlatHit(tMax);
    eachFlatBlock(features, view,
                  [&](const auto& block) { acceptFlat(intersectBlock(ray, block), block.primitive, best); });
    return nearestFlat(best, tMax);
}

RT_FN bool occludedFlat(shared::uint features, const AccelView& view, const ShapeRay& ray, float tMax) {
    const Float8 end = broadcast(tMax);
    Mask8 hits = end < end;
    eachFlatBlock(features, view, [&](const auto& block) {
        const LaneHits lanes = intersectBlock(ray, block);
        hits = hits | (lanes.mask & (lanes.t < end));
    });
    return bits(hits) != 0;
}

// Both for two rays from one point, on which most of the tests' work depends: what `ray` hits first, and whether anything lies
// along `shadow` before shadowEnd.
RT_FN shared::Hit traceFlatBoth(shared::uint features, const AccelView& view, const ShapeRay& ray,
                                const ShapeRay& shadow, float shadowEnd, bool& isOccluded) {
    const Float8 end = broadcast(shadowEnd);
    Mask8 hits = end < end;
    FlatBest best = noFlatHit(shared::kInfinity);
    eachFlatBlock(features, view, [&](const auto& block) {
        const LaneHits lanes = intersectBlock(shadow, block);
        hits = hits | (lanes.mask & (lanes.t < end));
        acceptFlat(intersectBlock(ray, block), block.primitive, best);
    });
    isOccluded = bits(hits) != 0;
    return nearestFlat(best, shared::kInfinity);
}

} // namespace
} // namespace rt::accel
