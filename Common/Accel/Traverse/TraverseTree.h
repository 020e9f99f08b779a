// Trees: the world's, those of instances below it, and that of many small things far apart.
#pragma once
#include "Common/Accel/Traverse/TraverseNodes.h"

namespace rt::accel {
namespace {

constexpr shared::Features kAnySpheres = shared::kFeatureSpheres | shared::kFeatureMovingSpheres;

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
RT_FN void traceTree(shared::Features features, const AccelView& view, Reference root, const shared::Ray& ray,
                     shared::uint instance, shared::Hit& best);
template <bool World, bool Ahead>
RT_FN bool occludedTree(shared::Features features, const AccelView& view, Reference root, const shared::Ray& ray,
                        float tMax);

// A ray in the space of the tree: as its leaves want it, and as it is.
struct LeafRay {
    ShapeRay shape;
    shared::Ray ray;
};

RT_FN LeafRay makeLeafRay(shared::Features features, const shared::Ray& ray, bool isUnit) {
    return {makeShapeRay(features, ray, isUnit), ray};
}

// Instances, which only the world has, are followed one level down.
template <bool World, bool Ahead>
RT_FN void traceLeaf(shared::Features features, const AccelView& view, Reference leaf, const LeafRay& ray,
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
    } else if (shared::has(features, kAnySpheres) && kind == LeafKind::NearSphere) {
        testLeaf(ray.shape, view.nearSpheres, leaf, shared::kSphere, instance, best);
    } else if (shared::has(features, shared::kRoundFeatures) && kind == LeafKind::Round) {
        testLeaf(ray.shape, view.rounds, leaf, shared::kRound, instance, best);
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
RT_FN bool occludedLeaf(shared::Features features, const AccelView& view, Reference leaf, const LeafRay& ray,
                        float tMax) {
    const LeafKind kind = leafKind(leaf);
    if (shared::has(features, shared::kFeatureTriangles) && kind == LeafKind::Triangle) {
        return testLeafAny(ray.shape, view.triangles, leaf, tMax);
    } else if (shared::has(features, shared::kFeatureSpheres) && kind == LeafKind::Sphere) {
        return testLeafAny(ray.shape, view.spheres, leaf, tMax);
    } else if (shared::has(features, shared::kFeatureQuads) && kind == LeafKind::Quad) {
        return testLeafAny(ray.shape, view.quads, leaf, tMax);
    } else if (shared::has(features, shared::kFeatureMovingSpheres) && kind == LeafKind::MovingSphere) {
        return testLeafAny(ray.shape, view.movingSpheres, leaf, tMax);
    } else if (shared::has(features, kAnySpheres) && kind == LeafKind::NearSphere) {
        return testLeafAny(ray.shape, view.nearSpheres, leaf, tMax);
    } else if (shared::has(features, shared::kRoundFeatures) && kind == LeafKind::Round) {
        return testLeafAny(ray.shape, view.rounds, leaf, tMax);
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
RT_FN void traceTree(shared::Features features, const AccelView& view, Reference root, const shared::Ray& ray,
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

// Whether anything is hit below `root`. Nodes are visited some at a time, without a branch that depends on what is met:
// so a processor overlaps them.
template <bool World, bool Ahead>
RT_FN bool occludedTree(shared::Features features, const AccelView& view, Reference root, const shared::Ray& ray,
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
            storeChildren(view.nodes[batch[i]], boxRay, tMax, waiting, size, leaves, found);
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

// ---- quantized trees, breadth-first --------------------------------------------------------------------------------

// Calls testLeaf(reference) for the leaves of the world that the ray may meet before tMax, which it may lower, until it
// returns true. Nodes are visited in the order in which they are found: which one is next does not depend on the last,
// so a processor overlaps many. When too many wait, the last comes first.
template <class TestLeaf>
RT_FN void visitQuantized(const AccelView& view, const shared::Ray& ray, const float& tMax, const TestLeaf& testLeaf) {
    constexpr unsigned kMany = 256;
    constexpr unsigned kAhead = 4; // nodes that are on their way from memory
    const float scale = view.quantizationGrid.stepsPerUnit;
    const BoxRay boxRay = makeBoxRay({(ray.origin - view.quantizationGrid.origin) * scale, ray.direction, ray.time});
    Reference queue[kMany + (kMaxTreeDepth + 2) * kWidth];
    Reference leaves[kMany];
    unsigned head = 0, tail = 1, found = 0;
    unsigned pause = 8; // after so many visits their leaves are tested: what is large is found first, and ends the ray
    queue[0] = 0;
    while (head != tail) {
        const float end = tMax * scale;
        while (head != tail && head != pause && found + kWidth <= kMany) {
            const QuantizedNode& node = view.quantizedNodes[tail < kMany ? queue[head++] : queue[--tail]];
            storeChildren(node, boxRay, end, queue, tail, leaves, found);
            const unsigned next = head + kAhead < tail ? head + kAhead : tail - 1;
            prefetchBytes<sizeof(QuantizedNode)>(view.quantizedNodes + queue[next]);
        }
        for (unsigned i = 0; i < found; ++i) {
            if (testLeaf(leaves[i])) return;
        }
        found = 0;
        if (head == pause) pause *= 4;
    }
}

} // namespace
} // namespace rt::accel
