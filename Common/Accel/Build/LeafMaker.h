// Gives the leaves of one tree their blocks and references.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "Common/Accel/AccelView.h"
#include "Common/Accel/Bvh.h"

namespace rt::accel {

// What a run of blocks holds: items of one kind.
struct LeafItems {
    LeafKind kind;
    std::uint32_t firstItem; // into LeafFilling::items
    std::uint32_t count;
    std::uint32_t firstBlock; // among the blocks of its kind
};

// Of one tree.
struct LeafFilling {
    std::vector<LeafItems> leaves;
    std::vector<std::uint32_t> items; // those of Bvh::items, leaf by leaf and ascending in each
};

// Blocks of each kind, in all trees.
struct BlockCounts {
    std::uint32_t of[kLeafKinds] = {};
};

// Small leaves of a kind share a block, also those of different nodes: the lanes of a block are tested together whether
// they are wanted or not, and full blocks save memory.
class LeafMaker {
  public:
    // The kind of a leaf is that of its first item: kinds[item], or kinds[0] where the span has only one element.
    LeafMaker(const Bvh& bvh, std::span<const std::uint8_t> kinds, BlockCounts& blocks, LeafFilling& filling);

    // The reference of a leaf. Leaves that follow one another should be neighbours in space. Throws RenderError when
    // there are more than kMaxBlocks blocks of a kind.
    Reference make(const BvhNode& leaf);

    // To be called when all leaves are made: completes the filling.
    void finish();

  private:
    static constexpr std::size_t kOpenBlocks = 4; // of a kind

    struct SharedBlock {
        std::array<std::uint32_t, kWidth> items{};
        std::uint32_t count = 0; // 0: there is no such block
        std::uint32_t index = 0;
    };

    std::uint32_t takeBlocks(std::uint32_t kind, std::uint32_t count);
    void addLeaf(std::uint32_t kind, std::uint32_t firstBlock, std::span<const std::uint32_t> items);
    SharedBlock& roomFor(std::uint32_t kind, std::size_t items);
    void close(std::uint32_t kind, SharedBlock& block);

    const Bvh& bvh_;
    const std::span<const std::uint8_t> kinds_;
    BlockCounts& blocks_;
    LeafFilling& filling_;
    std::array<SharedBlock, kOpenBlocks> shared_[kLeafKinds]; // have room
};

} // namespace rt::accel
