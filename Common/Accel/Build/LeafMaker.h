// Gives the leaves of one tree their blocks and references.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "Common/Accel/AccelView.h"
#include "Common/Accel/Build/TreeItems.h"
#include "Common/Accel/Bvh.h"

namespace rt::accel {

// Which primitive is in which lane of the blocks of each kind, of all trees: indices into the scene's arrays, kNone for
// an empty lane. What takes the place of a block of instances has one lane.
struct BlockLanes {
    std::vector<std::uint32_t> of[kLeafKinds];
};

constexpr std::uint32_t lanesOf(std::uint32_t kind) {
    return static_cast<LeafKind>(kind) == LeafKind::Instance ? 1 : kWidth;
}

// Small leaves of a kind share a block, also those of different nodes: the lanes of a block are tested together whether
// they are wanted or not, and full blocks save memory.
class LeafMaker {
  public:
    // Everything must outlive this object; `items` are those of the tree.
    LeafMaker(const Bvh& bvh, const TreeItems& items, BlockLanes& lanes);

    // The reference of a leaf. Leaves that follow one another should be neighbours in space. Throws RenderError when
    // there are more than kMaxBlocks blocks of a kind.
    Reference make(const BvhNode& leaf);

    // To be called when all leaves are made.
    void finish();

  private:
    static constexpr std::size_t kOpenBlocks = 4; // of a kind

    struct SharedBlock {
        std::uint32_t count = 0; // of lanes taken; 0: there is no such block
        std::uint32_t index = 0;
    };

    std::uint32_t takeBlocks(std::uint32_t kind, std::uint32_t count);
    void put(std::uint32_t kind, std::size_t lane, std::span<const std::uint32_t> items);
    SharedBlock& roomFor(std::uint32_t kind, std::size_t items);
    void close(std::uint32_t kind, SharedBlock& block);

    const Bvh& bvh_;
    const TreeItems& items_;
    BlockLanes& lanes_;
    std::array<SharedBlock, kOpenBlocks> shared_[kLeafKinds]; // have room
};

} // namespace rt::accel
