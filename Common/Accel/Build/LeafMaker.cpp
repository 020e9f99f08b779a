#include "Common/Accel/Build/LeafMaker.h"

#include <algorithm>

#include "Common/Core/Error.h"
#include "Common/Core/SystemMemory.h"

namespace rt::accel {
namespace {

Reference reference(std::uint32_t kind, std::uint32_t firstBlock, std::uint32_t count) {
    return kLeafBit | kind << kKindShift | (count - 1) << kCountShift | firstBlock;
}

std::uint32_t blocksOf(std::uint32_t kind, std::uint32_t items) {
    return (items + lanesOf(kind) - 1) / lanesOf(kind);
}

} // namespace

LeafMaker::LeafMaker(const Bvh& bvh, const TreeItems& items, BlockLanes& lanes)
    : bvh_(bvh), items_(items), lanes_(lanes) {
    // Lanes that nobody touches take no memory, while a vector that grows takes three times its own.
    std::size_t maximum[kLeafKinds] = {};
    for (const BvhNode& node : bvh.nodes) {
        if (!node.isLeaf()) continue;
        const auto kind = static_cast<std::uint32_t>(items.kind(bvh.items[node.first]));
        maximum[kind] += blocksOf(kind, node.count) * lanesOf(kind);
    }
    for (std::uint32_t kind = 0; kind < kLeafKinds; ++kind) {
        std::vector<std::uint32_t>& all = lanes_.of[kind];
        const std::size_t needed = all.size() + maximum[kind];
        if (needed > all.capacity()) reserveLarge(all, std::max(needed, 2 * all.size()));
    }
}

Reference LeafMaker::make(const BvhNode& leaf) {
    const auto kind = static_cast<std::uint32_t>(items_.kind(bvh_.items[leaf.first]));
    const std::span<const std::uint32_t> items(bvh_.items.data() + leaf.first, leaf.count);
    if (items.size() >= lanesOf(kind)) {
        const std::uint32_t count = blocksOf(kind, leaf.count);
        const std::uint32_t block = takeBlocks(kind, count);
        put(kind, std::size_t{block} * lanesOf(kind), items);
        return reference(kind, block, count);
    }
    SharedBlock& block = roomFor(kind, items.size());
    put(kind, std::size_t{block.index} * kWidth + block.count, items);
    block.count += leaf.count;
    return reference(kind, block.index, 1);
}

void LeafMaker::finish() {
    for (std::uint32_t kind = 0; kind < kLeafKinds; ++kind)
        for (SharedBlock& block : shared_[kind]) close(kind, block);
}

std::uint32_t LeafMaker::takeBlocks(std::uint32_t kind, std::uint32_t count) {
    std::vector<std::uint32_t>& lanes = lanes_.of[kind];
    const std::size_t first = lanes.size() / lanesOf(kind);
    if (first + count > kMaxBlocks)
        throw RenderError(
            "the scene has more primitives than an acceleration structure can hold (268 million of a kind)");
    lanes.resize(lanes.size() + std::size_t{count} * lanesOf(kind), shared::kNone);
    return static_cast<std::uint32_t>(first);
}

void LeafMaker::put(std::uint32_t kind, std::size_t lane, std::span<const std::uint32_t> items) {
    std::transform(items.begin(), items.end(), lanes_.of[kind].begin() + static_cast<std::ptrdiff_t>(lane),
                   [this](std::uint32_t item) { return items_.index(item); });
}

// The fullest block that takes so many items; where none does, a new one in place of the fullest.
LeafMaker::SharedBlock& LeafMaker::roomFor(std::uint32_t kind, std::size_t items) {
    SharedBlock* best = nullptr;
    for (SharedBlock& block : shared_[kind])
        if (block.count + items <= kWidth && (best == nullptr || block.count > best->count)) best = &block;
    if (best == nullptr) {
        best = std::max_element(shared_[kind].begin(), shared_[kind].end(),
                                [](const SharedBlock& a, const SharedBlock& b) { return a.count < b.count; });
        close(kind, *best);
    }
    if (best->count == 0) best->index = takeBlocks(kind, 1);
    return *best;
}

// Lanes are in the order of primitives, whatever leaves they are of.
void LeafMaker::close(std::uint32_t kind, SharedBlock& block) {
    const auto lanes = lanes_.of[kind].begin() + static_cast<std::ptrdiff_t>(block.index) * kWidth;
    if (block.count != 0) std::sort(lanes, lanes + block.count);
    block.count = 0;
}

} // namespace rt::accel
