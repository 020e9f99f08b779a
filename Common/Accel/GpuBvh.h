// The acceleration structure of the compute engine: see Common/Shared/TreeRecords.h for its layout and
// Shaders/Traverse.glsl for its traversal.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "Common/Accel/AccelInput.h"
#include "Common/Accel/Build/BvhBuilder.h"
#include "Common/Shared/Shape/TreeRecords.h"

namespace rt::accel {

// The trees of all geometries, appended to the same arrays.
struct GpuTrees {
    bool isWide = false; // wideNodes instead of nodes
    std::vector<shared::TreeNode> nodes;
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
};

// The primitives of a scene without instances, not sorted at all.
struct LinearLists {
    std::vector<shared::vec4> vectors;        // as in TreeRecords.h
    std::uint32_t spheres = 0;                // how many of each there are
    std::array<std::uint32_t, 3> axisQuads{}; // perpendicular to x, y, z
    std::uint32_t cuboids = 0;                // of the others' faces
    std::uint32_t quads = 0;                  // the rest
    std::uint32_t triangles = 0;
    std::uint32_t rounds = 0;
};

struct GpuBvh {
    bool isLinear = false; // the lists hold everything; otherwise the trees do
    LinearLists lists;
    GpuTrees trees;
};

struct GpuBvhSettings {
    BvhSettings tree;
    std::uint32_t maxLinear; // up to here, but at most kMaxListedPrimitives, there are lists instead of a tree
    GpuBvhSettings();        // those that were measured best
};

// Nothing when *cancel became true. Throws RenderError when there are more primitives of a kind than references can
// name.
std::optional<GpuBvh> buildGpuBvh(const AccelInput& input, const GpuBvhSettings& settings = {},
                                  const std::atomic<bool>* cancel = nullptr);

} // namespace rt::accel
