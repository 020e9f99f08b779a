// From the binary tree of a builder to the nodes of eight children that traversal wants.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "Common/Accel/AccelView.h"
#include "Common/Accel/Bvh.h"

namespace rt::accel {

// What some blocks hold: a run of items, which are of one kind.
struct WideLeaf {
    LeafKind kind;
    std::uint32_t firstItem; // into WideLeaves::items
    std::uint32_t count;
    std::uint32_t firstBlock; // among the blocks of its kind
};

// Of one tree.
struct WideLeaves {
    std::vector<WideLeaf> leaves;
    std::vector<std::uint32_t> items; // those of Bvh::items, leaf by leaf and ascending in each
};

// Nodes and leaves of any number of trees.
struct WideBvh {
    std::vector<WideNode> nodes;
    std::uint32_t blocks[kLeafKinds] = {}; // of each kind, in all trees

    // Appends a tree and returns the reference of its root; `leaves` receives what its blocks are to hold. Small leaves
    // of one node share a block, each with its own box. The kind of a leaf is that of its first item: kinds[item], or kinds[0] where the span has only one element. Throws
    // RenderError when there are more than kMaxBlocks blocks of a kind.
    Reference append(const Bvh& bvh, std::span<const std::uint8_t> kinds, WideLeaves& leaves);
};

} // namespace rt::accel
