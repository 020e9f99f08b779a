// Scenes without a tree: a few blocks, all of which every ray meets.
#pragma once
#include "Common/Accel/AccelView.h"
#include "Common/Accel/ShapeBlocks.h"
#include "Common/Accel/Simd/Simd.h"
#include "Common/Shared/Base/Features.h"

namespace rt::accel {
namespace {

// The nearest hit in each lane, over all blocks so far.
struct LaneBest {
    Float8 t, u, v;
    Index8 name;
};

RT_FN LaneBest noLaneHit(float tMax) {
    const Float8 zero = broadcast(0.0f);
    const LaneBest best{broadcast(tMax), zero, zero, {}};
    return best;
}

RT_FN void acceptLanes(const LaneHits& lanes, const std::uint32_t* names, LaneBest& best) {
    const Mask8 nearer = lanes.mask & (lanes.t < best.t);
    best.t = select(nearer, lanes.t, best.t);
    best.u = select(nearer, lanes.u, best.u);
    best.v = select(nearer, lanes.v, best.v);
    best.name = select(nearer, loadIndex(names), best.name);
}

RT_FN shared::Hit nearestOfLanes(const LaneBest& best, float tMax) {
    shared::Hit hit{-1.0f, 0, 0, shared::kNone, 0.0f, 0.0f};
    const float t = minimum(best.t);
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
    hit.kind = name >> kPackedKindShift;
    hit.primitive = name & ((1u << kPackedKindShift) - 1);
    return hit;
}

template <class Block, class Test>
RT_FN void forEachListedBlock(const LinearList<Block>& list, const Test& test) {
    for (const Block* block = list.blocks; block != list.blocks + list.count; ++block) test(*block);
}

// Calls test(block) for every block of the scene but those of disks and cylinders.
template <class Test>
RT_FN void forEachListedBlock(shared::Features features, const AccelView& view, const Test& test) {
    if (shared::has(features, shared::kFeatureSpheres)) forEachListedBlock(view.listedSpheres, test);
    if (shared::has(features, shared::kFeatureMovingSpheres)) forEachListedBlock(view.listedMovingSpheres, test);
    if (shared::has(features, shared::kFeatureSpheres | shared::kFeatureMovingSpheres))
        forEachListedBlock(view.listedNearSpheres, test);
    if (shared::has(features, shared::kFeatureQuads)) forEachListedBlock(view.listedQuads, test);
    if (shared::has(features, shared::kFeatureTriangles)) forEachListedBlock(view.listedTriangles, test);
}

RT_FN shared::Hit traceLinear(shared::Features features, const AccelView& view, const ShapeRay& ray, float tMax) {
    LaneBest best = noLaneHit(tMax);
    const auto test = [&](const auto& block) { acceptLanes(intersectBlock(ray, block), block.primitive, best); };
    forEachListedBlock(features, view, test);
    if (shared::has(features, shared::kRoundFeatures)) forEachListedBlock(view.listedRounds, test);
    return nearestOfLanes(best, tMax);
}

RT_FN bool occludedLinear(shared::Features features, const AccelView& view, const ShapeRay& ray, float tMax) {
    const Float8 end = broadcast(tMax);
    Mask8 hits = end < end;
    const auto test = [&](const auto& block) {
        const LaneHits lanes = intersectBlock(ray, block);
        hits = hits | (lanes.mask & (lanes.t < end));
    };
    forEachListedBlock(features, view, test);
    if (shared::has(features, shared::kRoundFeatures)) forEachListedBlock(view.listedRounds, test);
    return bits(hits) != 0;
}

// Both for two rays from one point, on which most of the tests' work depends: what `ray` hits first, and whether
// anything lies along `shadow` before shadowEnd. Not where there are disks or cylinders.
RT_FN shared::Hit traceLinearWithShadow(shared::Features features, const AccelView& view, const ShapeRay& ray,
                                        const ShapeRay& shadow, float shadowEnd, bool& isOccluded) {
    const Float8 end = broadcast(shadowEnd);
    Mask8 hits = end < end;
    LaneBest best = noLaneHit(shared::kInfinity);
    forEachListedBlock(features, view, [&](const auto& block) {
        const LaneHits lanes = intersectBlock(shadow, block);
        hits = hits | (lanes.mask & (lanes.t < end));
        acceptLanes(intersectBlock(ray, block), block.primitive, best);
    });
    isOccluded = bits(hits) != 0;
    return nearestOfLanes(best, shared::kInfinity);
}

} // namespace
} // namespace rt::accel
