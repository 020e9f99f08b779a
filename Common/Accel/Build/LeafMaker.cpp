#include "Common/Accel/Build/LeafMaker.h"

#include <algorithm>

#include "Common/Core/Error.h"
#include "Common/Core/SystemMemory.h"

namespace rt::accel {
namespace {

Reference reference(std::uint32_t kind, std::uint32_t firstBlock, std::uint32_t count) {
    return kLeafBit | kind << kKindShift | (count - 1) << kCountShift | firstBlock;
}

} // namespace

LeafMaker::LeafMaker(const Bvh& bvh, std::span<const std::uint8_t> kinds, BlockCounts& blocks, LeafFilling& filling)
    : bvh_(bvh), kinds_(kinds), blocks_(blocks), filling_(filling) {
    reserveLarge(filling_.items, bvh.items.size());
}

Reference LeafMaker::make(const BvhNode& leaf) {
    const std::uint32_t kind = kinds_[kinds_.size() == 1 ? 0 : bvh_.items[leaf.first]];
    const std::span<const std::uint32_t> items(bvh_.items.data() + leaf.first, leaf.count);
    const bool isInstance = static_cast<LeafKind>(kind) == LeafKind::Instance;
    if (isInstance || items.size() >= kWidth) {
        const std::uint32_t count = isInstance ? leaf.count : (leaf.count + kWidth - 1) / kWidth;
        const std::uint32_t block = takeBlocks(kind, count);
        addLeaf(kind, block, items);
        return reference(kind, block, count);
    }
    SharedBlock& block = roomFor(kind, items.size());
    std::copy(items.begin(), items.end(), block.items.begin() + block.count);
    block.count += leaf.count;
    return reference(kind, block.index, 1);
}

void LeafMaker::finish() {
    for (std::uint32_t kind = 0; kind < kLeafKinds; ++kind)
        for (SharedBlock& block : shared_[kind]) close(kind, block);
}

std::uint32_t LeafMaker::takeBlocks(std::uint32_t kind, std::uint32_t count) {
    if (blocks_.of[kind] + count > kMaxBlocks)
        throw RenderError(
            "the scene has more primitives than an acceleration structure can hold (268 million of a kind)");
    blocks_.of[kind] += count;
    return blocks_.of[kind] - count;
}

void LeafMaker::addLeaf(std::uint32_t kind, std::uint32_t firstBlock, std::span<const std::uint32_t> items) {
    const std::size_t first = filling_.items.size();
    filling_.items.insert(filling_.items.end(), items.begin(), items.end());
    std::sort(filling_.items.begin() + static_cast<std::ptrdiff_t>(first), filling_.items.end());
    filling_.leaves.push_back({static_cast<LeafKind>(kind), static_cast<std::uint32_t>(first),
                               static_cast<std::uint32_t>(items.size()), firstBlock});
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

void LeafMaker::close(std::uint32_t kind, SharedBlock& block) {
    if (block.count != 0) addLeaf(kind, block.index, std::span(block.items).first(block.count));
    block.count = 0;
}

} // namespace rt::accel
