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
#include "Common/Accel/AccelView.h"
#include "Common/Accel/Prefetch.h"
#include "Common/Accel/ShapeBlocks.h"
#include "Common/Accel/Simd.h"
#include "Common/Shared/Features.h"

namespace rt::accel {
namespace {

constexpr float kLargest = 3.402823466e+38f;

// ---- nearest of the lanes that were hit -----------------------------------------------------------------------------

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
        const float nearest = least(select(mask, lanes.t, broadcast(kLargest)));
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

// ---- scenes without a tree ------------------------------------------------------------------------------------------

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

// ---- nodes ----------------------------------------------------------------------------------------------------------

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
RT_FN Float8 loadPlanes(const SparseNode& node, unsigned i) {
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
RT_FN void prefetchReference(shared::uint features, const AccelView& view, Reference r) {
    if ((r & kLeafBit) == 0) {
        prefetchBytes<sizeof(WideNode)>(view.nodes + r);
    } else if (shared::has(features, shared::kFeatureTriangles) && leafKind(r) == LeafKind::Triangle) {
        prefetchBytes<sizeof(TriangleBlock)>(view.triangles + leafFirst(r));
    } else if (shared::has(features, shared::kFeatureSpheres) && leafKind(r) == LeafKind::Sphere) {
        prefetchBytes<sizeof(SphereBlock)>(view.spheres + leafFirst(r));
    } else if (shared::has(features, shared::kFeatureQuads) && leafKind(r) == LeafKind::Quad) {
        prefetchBytes<sizeof(QuadBlock)>(view.quads + leafFirst(r));
    }
}

// ---- trees ----------------------------------------------------------------------------------------------------------

RT_FN shared::Ray toObject(const PlacedGeometry& placed, const shared::Ray& ray) {
    shared::Ray r = ray;
    for (int row = 0; row < 3; ++row) {
        const shared::vec4 m = placed.toObject[row];
        r.origin[row] = m.x * ray.origin.x + m.y * ray.origin.y + m.z * ray.origin.z + m.w;
        r.direction[row] = m.x * ray.direction.x + m.y * ray.direction.y + m.z * ray.direction.z;
    }
    return r;
}

template <bool World, bool Ahead>
RT_FN void traceTree(shared::uint features, const AccelView& view, Reference root, const shared::Ray& ray,
                     shared::uint instance, shared::Hit& best);
template <bool World, bool Ahead>
RT_FN bool occludedTree(shared::uint features, const AccelView& view, Reference root, const shared::Ray& ray,
                        float tMax);

// A ray in the space of the tree: as its leaves want it, and as it is.
struct LeafRay {
    ShapeRay shape;
    shared::Ray ray;
};

RT_FN LeafRay makeLeafRay(shared::uint features, const shared::Ray& ray, bool isUnit) {
    return {makeShapeRay(features, ray, isUnit), ray};
}

// Instances, which only the world has, are followed one level down.
template <bool World, bool Ahead>
RT_FN void traceLeaf(shared::uint features, const AccelView& view, Reference leaf, const LeafRay& ray,
                     shared::uint instance, shared::Hit& best) {
    const LeafKind kind = leafKind(leaf);
    if (shared::has(features, shared::kFeatureTriangles) && kind == LeafKind::Triangle) {
        testLeaf(ray.shape, view.triangles, leaf, shared::kTriangle, instance, best);
    } else if (shared::has(features, shared::kFeatureSpheres) && kind == LeafKind::Sphere) {
        testLeaf(ray.shape, view.spheres, leaf, shared::kSphere, instance, best);
    } else if (shared::has(features, shared::kFeatureQuads) && kind == LeafKind::Quad) {
        testLeaf(ray.shape, view.quads, leaf, shared::kQuad, instance, best);
    } else if (shared::has(features, shared::kFeatureMovingSpheres) && kind == LeafKind::MovingSphere) {
        testLeaf(ray.shape, view.movingSpheres, leaf, shared::kSphere, instance, best);
    } else if constexpr (World) {
        if (shared::has(features, shared::kFeatureInstances)) {
            const PlacedGeometry* placed = view.instances + leafFirst(leaf);
            for (const PlacedGeometry* end = placed + leafBlocks(leaf); placed != end; ++placed) {
                traceTree<false, Ahead>(features, view, placed->root, toObject(*placed, ray.ray), placed->instance,
                                        best);
            }
        }
    }
}

template <bool World, bool Ahead>
RT_FN bool occludedLeaf(shared::uint features, const AccelView& view, Reference leaf, const LeafRay& ray, float tMax) {
    const LeafKind kind = leafKind(leaf);
    if (shared::has(features, shared::kFeatureTriangles) && kind == LeafKind::Triangle) {
        return testLeafAny(ray.shape, view.triangles, leaf, tMax);
    } else if (shared::has(features, shared::kFeatureSpheres) && kind == LeafKind::Sphere) {
        return testLeafAny(ray.shape, view.spheres, leaf, tMax);
    } else if (shared::has(features, shared::kFeatureQuads) && kind == LeafKind::Quad) {
        return testLeafAny(ray.shape, view.quads, leaf, tMax);
    } else if (shared::has(features, shared::kFeatureMovingSpheres) && kind == LeafKind::MovingSphere) {
        return testLeafAny(ray.shape, view.movingSpheres, leaf, tMax);
    } else if constexpr (World) {
        if (shared::has(features, shared::kFeatureInstances)) {
            const PlacedGeometry* placed = view.instances + leafFirst(leaf);
            for (const PlacedGeometry* end = placed + leafBlocks(leaf); placed != end; ++placed) {
                if (occludedTree<false, Ahead>(features, view, placed->root, toObject(*placed, ray.ray), tMax))
                    return true;
            }
        }
    }
    return false;
}

// Nearest hit below `root`, if nearer than `best`. Ahead: what waits is fetched from memory meanwhile, for trees that a
// core's own cache does not hold.
template <bool World, bool Ahead>
RT_FN void traceTree(shared::uint features, const AccelView& view, Reference root, const shared::Ray& ray,
                     shared::uint instance, shared::Hit& best) {
    const BoxRay boxRay = makeBoxRay(ray);
    const LeafRay leafRay = makeLeafRay(features, ray, World);
    StackEntry stack[kStackSize];
    unsigned size = 0;
    Reference current = root;
    for (;;) {
        if ((current & kLeafBit) == 0) {
            const WideNode& node = view.nodes[current];
            Float8 entry;
            const unsigned hits = enterChildren(node, boxRay, best.t, entry);
            if (hits != 0) {
                [[maybe_unused]] const unsigned waiting = size;
                current = orderChildren(node, hits, entry, stack, size);
                if constexpr (Ahead) {
                    for (unsigned i = waiting; i < size; ++i) prefetchReference(features, view, stack[i].reference);
                }
                continue;
            }
        } else {
            traceLeaf<World, Ahead>(features, view, current, leafRay, instance, best);
        }
        do {
            if (size == 0) return;
            --size;
        } while (stack[size].t > best.t);
        current = stack[size].reference;
    }
}

// Whether anything is hit below `root`. Nodes are visited some at a time, without a branch that depends on what is met: so
// a processor overlaps them.
template <bool World, bool Ahead>
RT_FN bool occludedTree(shared::uint features, const AccelView& view, Reference root, const shared::Ray& ray,
                        float tMax) {
    constexpr unsigned kBatch = Ahead ? 4 : 2;
    const BoxRay boxRay = makeBoxRay(ray);
    const LeafRay leafRay = makeLeafRay(features, ray, World);
    if ((root & kLeafBit) != 0) return occludedLeaf<World, Ahead>(features, view, root, leafRay, tMax);
    // A level of the tree adds no more than the children of one batch.
    Reference waiting[((kMaxTreeDepth + 1) * kBatch + 1) * kWidth];
    Reference leaves[(kBatch + 1) * kWidth];
    Reference batch[kBatch];
    waiting[0] = root;
    unsigned size = 1;
    do {
        const unsigned count = size < kBatch ? size : kBatch;
        size -= count;
        for (unsigned i = 0; i < count; ++i) batch[i] = waiting[size + i];
        unsigned found = 0;
        for (unsigned i = 0; i < count; ++i) {
            const WideNode& node = view.nodes[batch[i]];
            Float8 entry;
            const unsigned hits = enterChildren(node, boxRay, tMax, entry);
            const Index8 children = loadIndex(node.child);
            const unsigned isLeaf = topBits(children);
            size += storePacked(waiting + size, children, hits & ~isLeaf);
            found += storePacked(leaves + found, children, hits & isLeaf);
        }
        if constexpr (Ahead) {
            for (unsigned i = size < kBatch ? 0 : size - kBatch; i < size; ++i) {
                prefetchBytes<sizeof(WideNode)>(view.nodes + waiting[i]);
            }
        }
        for (unsigned i = 0; i < found; ++i) {
            if (occludedLeaf<World, Ahead>(features, view, leaves[i], leafRay, tMax)) return true;
        }
    } while (size != 0);
    return false;
}

// ---- sparse trees ---------------------------------------------------------------------------------------------------

// Calls testLeaf(reference) for the leaves of the world that the ray may meet before tMax, which it may lower, until it
// returns true. Nodes are visited in the order in which they are found: which one is next does not depend on the last,
// so a processor overlaps many. When too many wait, the last comes first.
template <class TestLeaf>
RT_FN void visitSparse(const AccelView& view, const shared::Ray& ray, const float& tMax, const TestLeaf& testLeaf) {
    constexpr unsigned kMany = 256;
    constexpr unsigned kAhead = 4; // nodes that are on their way from memory
    const float scale = view.sparseGrid.stepsPerUnit;
    const BoxRay boxRay = makeBoxRay({(ray.origin - view.sparseGrid.origin) * scale, ray.direction, ray.time});
    Reference queue[kMany + (kMaxTreeDepth + 2) * kWidth];
    Reference leaves[kMany];
    unsigned head = 0, tail = 1, found = 0;
    unsigned pause = 8; // after so many visits their leaves are tested: what is large is found first, and ends the ray
    queue[0] = 0;
    while (head != tail) {
        const float end = tMax * scale;
        while (head != tail && head != pause && found + kWidth <= kMany) {
            const SparseNode& node = view.sparseNodes[tail < kMany ? queue[head++] : queue[--tail]];
            Float8 entry;
            const unsigned hits = enterChildren(node, boxRay, end, entry);
            const Index8 children = loadIndex(node.child);
            const unsigned isLeaf = topBits(children);
            tail += storePacked(queue + tail, children, hits & ~isLeaf);
            found += storePacked(leaves + found, children, hits & isLeaf);
            const unsigned next = head + kAhead < tail ? head + kAhead : tail - 1;
            prefetchBytes<sizeof(SparseNode)>(view.sparseNodes + queue[next]);
        }
        for (unsigned i = 0; i < found; ++i) {
            if (testLeaf(leaves[i])) return;
        }
        found = 0;
        if (head == pause) pause *= 4;
    }
}

// ---- the two questions ----------------------------------------------------------------------------------------------

// The nearest hit with 0 < t < tMax; its t is negative if there is none.
RT_FN shared::Hit traceClosest(shared::uint features, const AccelView& view, const shared::Ray& ray, float tMax) {
    if (view.flat) return traceFlat(features, view, makeShapeRay(features, ray, true), tMax);
    shared::Hit best{tMax, 0, 0, shared::kNone, 0.0f, 0.0f};
    if (view.sparseNodes != nullptr) {
        const LeafRay leafRay = makeLeafRay(features, ray, true);
        visitSparse(view, ray, best.t, [&](Reference leaf) {
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
RT_FN bool occluded(shared::uint features, const AccelView& view, const shared::Ray& ray, float tMax) {
    if (view.flat) return occludedFlat(features, view, makeShapeRay(features, ray, true), tMax);
    if (view.sparseNodes != nullptr) {
        const LeafRay leafRay = makeLeafRay(features, ray, true);
        bool isHit = false;
        visitSparse(view, ray, tMax, [&](Reference leaf) {
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
