// The trees of small ranges of items.
#pragma once
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "Common/Accel/Build/BinnedSplit.h"
#include "Common/Accel/Build/BvhBuilder.h"
#include "Common/Accel/Bvh.h"

namespace rt::accel {

// A range of items, whose tree is to be built.
struct BvhRange {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::uint32_t node = 0;
    std::uint32_t depth = 0;
    int order = 0; // which of the orders its items are in; of no meaning within a task
    Bounds box = Bounds::empty();
    Bounds centers = Bounds::empty(); // of ItemBox::center()

    std::uint32_t size() const { return end - begin; }
    // The two ranges that it is divided into.
    void divide(std::uint32_t lefts, BvhRange& left, BvhRange& right) const {
        left.begin = begin;
        left.end = right.begin = begin + lefts;
        right.end = end;
        left.depth = right.depth = depth + 1;
    }
};

// As ItemBox::center(): twice the centre.
inline Float4 centerOf(const Bounds& box) {
    return box.lower + box.upper;
}

// Adds two children to node `parent` and names them in the ranges.
inline void addChildren(std::vector<BvhNode>& nodes, std::uint32_t parent, BvhRange& left, BvhRange& right) {
    left.node = static_cast<std::uint32_t>(nodes.size());
    right.node = left.node + 1;
    nodes[parent].first = left.node;
    nodes[parent].count = 0;
    nodes.push_back({left.box.box(), 0, 0});
    nodes.push_back({right.box.box(), 0, 0});
}

// Where items go when a range is divided: the first `left` in the order of a plane, of a group, or as they stand.
struct Division {
    enum class By { Plane, Group, Count } by = By::Plane;
    Split split;
    std::uint32_t group = 0;
};

// The tree of a range, built by one thread from copies of its boxes, which a core's own cache holds.
class BvhTask {
  public:
    BvhTask(const BvhSettings& settings, bool grouped, std::vector<ItemBox> items)
        : settings_(settings),
          grouped_(grouped),
          items_(std::move(items)),
          scratch_(std::make_unique_for_overwrite<ItemBox[]>(items_.size())) {}

    // Leaves name places in `order`, which gets the items, from `range.begin` on.
    std::vector<BvhNode> build(const BvhRange& range, std::vector<std::uint32_t>& order);

  private:
    std::uint32_t binCount(std::uint32_t items) const { return std::min(settings_.bins, 4 + items / 8); }
    bool isMixed(const BvhRange& range) const;
    // The plane to divide at; by count where no plane helps; nothing if the range is to be a leaf.
    std::optional<Division> choose(const BvhRange& range, const BinSums& sums, bool binned, bool isMixedLeaf) const;
    std::optional<Division> chooseForLeaf(const BvhRange& range) const;
    void partition(const BvhRange& range, const Division& division, const Binning& binning, BvhRange& left,
                   BvhRange& right);

    const BvhSettings& settings_;
    const bool grouped_;
    std::vector<ItemBox> items_;
    const std::unique_ptr<ItemBox[]> scratch_; // as many
};

} // namespace rt::accel
