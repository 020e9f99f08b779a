// The acceleration structure of the compute engine: see Common/Shared/TreeRecords.h for its layout and
// Shaders/Traverse.glsl for its traversal.
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "Common/Accel/AccelInput.h"
#include "Common/Accel/Box.h"
#include "Common/Accel/Build/BvhBuilder.h"
#include "Common/Shared/Shape/TreeRecords.h"

namespace rt::accel {

// Elements of the arrays of trees.
struct TreeCounts {
    std::size_t nodes = 0; // of either kind
    std::size_t spheres = 0;
    std::size_t quads = 0;
    std::size_t triangles = 0;
    std::size_t rounds = 0;
};

// The trees of all geometries but the world's, and what the world's has to know of them.
struct PlacedTrees {
    bool isWide = false;               // wideNodes instead of nodes, also of the world
    TreeCounts counts;                 // they are the first of the arrays
    std::vector<std::uint32_t> roots;  // of each geometry
    std::vector<std::uint32_t> depths; // of each geometry: references that a traversal of it has to remember
    std::vector<Box> boxes;            // of each geometry
};

// The trees of all geometries, appended to the same arrays, the world's last.
struct GpuTrees {
    std::vector<shared::TreeNode> nodes; // or the next, as placed.isWide says
    std::vector<shared::WideTreeNode> wideNodes;
    std::vector<shared::vec4> spheres;        // center, radius; that is negative for near spheres
    std::vector<shared::vec4> sphereMotions;  // of each of them; empty: nothing moves
    std::vector<std::uint32_t> sphereIndices; // of each of them in the scene
    std::vector<shared::TreeQuad> quads;
    std::vector<shared::TreeTriangle> triangles;
    std::vector<shared::TreeRound> rounds;
    std::vector<std::uint32_t> instanceRoots; // of each instance's geometry; meaningless for an empty one
    std::uint32_t root = 0;                   // the world's
    std::uint32_t depth = 0;                  // most references that a traversal has to remember
    PlacedTrees placed;
};

// The primitives of a scene without instances, not sorted at all; or those near spheres of a world with a tree whose
// boxes nearly all rays would enter, which are then in no leaf.
struct LinearLists {
    std::vector<shared::vec4> vectors;        // as in TreeRecords.h
    std::uint32_t nearSpheres = 0;            // how many of each there are: first the near spheres of Shapes.h,
    std::uint32_t spheres = 0;                // then the others
    std::array<std::uint32_t, 3> axisQuads{}; // perpendicular to x, y, z
    std::uint32_t cuboids = 0;                // of the others' faces
    std::uint32_t quads = 0;                  // the rest
    std::uint32_t triangles = 0;
    std::uint32_t rounds = 0;
};

struct GpuBvh {
    bool isLinear = false; // the lists hold everything; otherwise the trees do, but for what is listed beside them
    LinearLists lists;
    GpuTrees trees;
};

struct GpuBvhSettings {
    BvhSettings tree;
    std::uint32_t maxLinear; // up to here, but at most kMaxListedPrimitives, there are lists instead of a tree
    GpuBvhSettings();        // those that were measured best
};

// Nothing when *cancel became true. Throws RenderError when there are more primitives of a kind than references can
// name. `placed`: trees that are there already; the arrays then hold what goes behind theirs.
std::optional<GpuBvh> buildGpuBvh(const AccelInput& input, const GpuBvhSettings& settings = {},
                                  const std::atomic<bool>* cancel = nullptr, const PlacedTrees* placed = nullptr);

// Whether those of a scene `before` are those of another version of it.
bool canKeep(const PlacedTrees& placed, const AccelInput& before, const AccelInput& now);

} // namespace rt::accel
