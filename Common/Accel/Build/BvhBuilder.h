// Builds binary hierarchies by the surface area heuristic over binned centroids (Wald, "On fast Construction of
// SAH-based Bounding Volume Hierarchies", 2007), on many threads, with the same result for any number of them.
#pragma once
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "Common/Accel/Bvh.h"

namespace rt::accel {

struct BvhSettings {
    std::uint32_t bins = 16; // most planes tried along an axis; 2 to 32
    std::uint32_t blockSize =
        8; // items that a traversal tests together: a leaf of n items costs ceil(n / blockSize) blocks
    std::uint32_t maxLeafSize = 64;         // items, at least blockSize
    std::uint32_t singleGroup = 0xffffffff; // items of this group are alone in their leaf
    float nodeCost = 0.5f;                  // of visiting a binary node, in units of a block's test
    std::uint32_t maxDepth = 60; // of the tree; beyond half of it ranges are halved by count. At least 2 log2(items)
    std::size_t threads = 0;     // 0: as many as the machine has. The tree does not depend on it
};

// A box of each item. Items of different groups never share a leaf; `groups` has one element for each box, or one for
// all alike, or none (group 0).
struct BvhInput {
    std::vector<Box> boxes; // finite, lower <= upper
    std::span<const std::uint8_t> groups;
};

// Nothing when *cancel became true. *itemsDone, if given, rises by the number of boxes while the build goes on.
std::optional<Bvh> buildBvh(BvhInput input, const BvhSettings& settings, const std::atomic<bool>* cancel = nullptr,
                            std::atomic<std::uint64_t>* itemsDone = nullptr);

} // namespace rt::accel
