// What the traversal of a tree is made of: the test of a node, the order of its children, the nearest hit in a
// leaf.
#pragma once
#include "Common/Accel/AccelView.h"
#include "Common/Accel/ShapeBlocks.h"
#include "Common/Accel/Simd/Prefetch.h"
#include "Common/Accel/Simd/Simd.h"
#include "Common/Shared/Base/Features.h"

namespace rt::accel {
namespace {

constexpr float kLargest = 3.402823466e+38f;

RT_FN bool comesBefore(shared::uint instance, shared::uint kind, shared::uint primitive, const shared::Hit& hit) {
    if (instance != hit.instance) return instance + 1 < hit.instance + 1; // kNone, the world, is the first
    return kind != hit.kind ? kind < hit.kind : primitive < hit.primitive;
}

RT_FN void acceptNearest(const LaneHits& lanes, shared::uint kind, const std::uint32_t* primitives,
                         shared::uint instance, shared::Hit& best) {
    const Mask8 mask = lanes.mask & (lanes.t <= broadcast(best.t));
    unsigned hits = bits(mask);
    if (hits == 0) return;
    if ((hits & (hits - 1)) != 0) {
        const float nearest = minimum(select(mask, lanes.t, broadcast(kLargest)));
        hits = bits(mask & (lanes.t == broadcast(nearest)));
    }
    const unsigned i = lowestBit(hits);
    const float t = lane(lanes.t, i);
    if (t == best.t && !comesBefore(instance, kind, primitives[i], best)) return;
    best.t = t;
    best.kind = kind;
    best.primitive = primitives[i];
    best.instance = instance;
    best.u = lane(lanes.u, i);
    best.v = lane(lanes.v, i);
}

// A ray as the slab test wants it. Reciprocals are widened so that rounding, theirs and that of the primitives' own
// tests, can only let more boxes in: Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013.
struct BoxRay {
    float origin[3];
    float inverseNear[3];
    float inverseFar[3];
    unsigned nearPlane[3]; // index into WideNode::planes; the far one differs in the last bit
};

const float kSlabError = 8.0f * shared::kEpsilon;

RT_FN BoxRay makeBoxRay(const shared::Ray& ray) {
    BoxRay r;
    for (unsigned a = 0; a < 3; ++a) {
        const float inverse = 1.0f / ray.direction[static_cast<int>(a)]; // infinite along a slab
        r.origin[a] = ray.origin[static_cast<int>(a)];
        r.inverseNear[a] = inverse * (1.0f - kSlabError);
        r.inverseFar[a] = inverse * (1.0f + kSlabError);
        r.nearPlane[a] = 2 * a + (shared::floatBitsToUint(ray.direction[static_cast<int>(a)]) >> 31);
    }
    return r;
}

RT_FN Float8 loadPlanes(const WideNode& node, unsigned i) {
    return load(node.planes[i]);
}
RT_FN Float8 loadPlanes(const QuantizedNode& node, unsigned i) {
    return fromWords(node.planes[i]);
}

// Bit i is set where the ray may meet child i within [0, tMax]; entry: where it enters each child. A ray that runs in
// the plane of a slab gives 0 * infinity there; minimum and maximum pass over it because it is their first argument.
template <class Node>
RT_FN unsigned enterChildren(const Node& node, const BoxRay& ray, float tMax, Float8& entry) {
    Float8 t0 = broadcast(0.0f);
    Float8 t1 = broadcast(tMax);
    for (unsigned a = 0; a < 3; ++a) {
        const Float8 origin = broadcast(ray.origin[a]);
        const Float8 near = loadPlanes(node, ray.nearPlane[a]);
        const Float8 far = loadPlanes(node, ray.nearPlane[a] ^ 1u);
        t0 = maximum((near - origin) * broadcast(ray.inverseNear[a]), t0);
        t1 = minimum((far - origin) * broadcast(ray.inverseFar[a]), t1);
    }
    entry = t0;
    return bits(t0 <= t1);
}

// Puts the children that the ray may meet before tMax behind those that wait: nodes among nodes, leaves among leaves.
template <class Node>
RT_FN void storeChildren(const Node& node, const BoxRay& ray, float tMax, Reference* nodes, unsigned& nodeCount,
                         Reference* leaves, unsigned& leafCount) {
    Float8 entry;
    const unsigned hits = enterChildren(node, ray, tMax, entry);
    const Index8 children = loadIndex(node.child);
    const unsigned isLeaf = topBits(children);
    nodeCount += storePacked(nodes + nodeCount, children, hits & ~isLeaf);
    leafCount += storePacked(leaves + leafCount, children, hits & isLeaf);
}

struct StackEntry {
    float t; // where the ray enters
    Reference reference;
};

constexpr unsigned kStackSize = kMaxTreeDepth * (kWidth - 1) + 1;

// Of the children in `hits` the nearest is returned, the others go on the stack, the nearest of them on top.
RT_FN Reference orderChildren(const WideNode& node, unsigned hits, Float8 entry, StackEntry* stack, unsigned& size) {
    unsigned i = lowestBit(hits);
    hits &= hits - 1;
    if (hits == 0) return node.child[i];
    alignas(32) float t[8];
    store(t, entry);
    StackEntry nearest{t[i], node.child[i]};
    const unsigned bottom = size;
    do {
        i = lowestBit(hits);
        hits &= hits - 1;
        StackEntry next{t[i], node.child[i]};
        if (next.t < nearest.t) {
            const StackEntry swap = next;
            next = nearest;
            nearest = swap;
        }
        unsigned at = size++;
        for (; at > bottom && stack[at - 1].t < next.t; --at) {
            stack[at] = stack[at - 1];
        }
        stack[at] = next;
    } while (hits != 0);
    return nearest.reference;
}

RT_FN unsigned leafBlocks(Reference leaf) {
    return (leaf >> kCountShift & (kMaxLeafBlocks - 1)) + 1;
}
RT_FN LeafKind leafKind(Reference leaf) {
    return static_cast<LeafKind>(leaf >> kKindShift & 7u);
}
RT_FN std::uint32_t leafFirst(Reference leaf) {
    return leaf & (kMaxBlocks - 1);
}

template <class Block>
RT_FN void testLeaf(const ShapeRay& ray, const Block* blocks, Reference leaf, shared::uint kind, shared::uint instance,
                    shared::Hit& best) {
    const Block* block = blocks + leafFirst(leaf);
    for (const Block* end = block + leafBlocks(leaf); block != end; ++block) {
        acceptNearest(intersectBlock(ray, *block), kind, block->primitive, instance, best);
    }
}

template <class Block>
RT_FN bool testLeafAny(const ShapeRay& ray, const Block* blocks, Reference leaf, float tMax) {
    const Block* block = blocks + leafFirst(leaf);
    for (const Block* end = block + leafBlocks(leaf); block != end; ++block) {
        const LaneHits lanes = intersectBlock(ray, *block);
        if (bits(lanes.mask & (lanes.t < broadcast(tMax))) != 0) return true;
    }
    return false;
}

template <unsigned kBytes>
RT_FN void prefetchBytes(const void* at) {
    for (unsigned i = 0; i < kBytes; i += 64) prefetch(static_cast<const char*>(at) + i);
}

// Starts to fetch what `r` refers to: the first block of a leaf.
RT_FN void prefetchReference(shared::Features features, const AccelView& view, Reference r) {
    if ((r & kLeafBit) == 0) {
        prefetchBytes<sizeof(WideNode)>(view.nodes + r);
    } else if (shared::has(features, shared::kFeatureTriangles) && leafKind(r) == LeafKind::Triangle) {
        prefetchBytes<sizeof(TriangleBlock)>(view.triangles + leafFirst(r));
    } else if (shared::has(features, shared::kFeatureSpheres) && leafKind(r) == LeafKind::Sphere) {
        prefetchBytes<sizeof(SphereBlock)>(view.spheres + leafFirst(r));
    } else if (shared::has(features, shared::kFeatureSpheres) && leafKind(r) == LeafKind::NearSphere) {
        prefetchBytes<sizeof(NearSphereBlock)>(view.nearSpheres + leafFirst(r));
    } else if (shared::has(features, shared::kFeatureQuads) && leafKind(r) == LeafKind::Quad) {
        prefetchBytes<sizeof(QuadBlock)>(view.quads + leafFirst(r));
    } else if (shared::has(features, shared::kRoundFeatures) && leafKind(r) == LeafKind::Round) {
        prefetchBytes<sizeof(RoundBlock)>(view.rounds + leafFirst(r));
    }
}

} // namespace
} // namespace rt::accel
