#include "Common/Accel/Build/BvhBuilder.h"

#include <algorithm>
#include <array>

#include "Common/Accel/Build/BinnedSplit.h"
#include "Common/Accel/Build/BvhTask.h"
#include "Common/Accel/Simd/Prefetch.h"
#include "Common/Core/Parallel.h"
#include "Common/Core/SystemMemory.h"

namespace rt::accel {
namespace {

// Ranges above this many items are divided by all threads together, one after the other; those below are trees of their
// own, each built by one thread. Part of the result: it must not depend on the machine.
constexpr std::uint32_t kTaskItems = 1u << 14;
constexpr std::size_t kChunkItems = 1u << 13;
constexpr std::size_t kAhead = 16; // boxes that are fetched before they are looked at

class Builder {
  public:
    Builder(BvhInput& input, const BvhSettings& settings, const std::atomic<bool>* cancel,
            std::atomic<std::uint64_t>* itemsDone)
        : input_(input),
          settings_(settings),
          cancel_(cancel),
          itemsDone_(itemsDone),
          grouped_(input.groups.size() > 1),
          firstGroup_(input.groups.empty() ? 0u : input.groups[0]) {}

    std::optional<Bvh> build();

  private:
    bool cancelled() const { return cancel_ != nullptr && cancel_->load(std::memory_order_relaxed); }
    BvhRange prepareItems();
    void divideTogether(const BvhRange& range, std::vector<BvhNode>& nodes, std::vector<BvhRange>& large,
                        std::vector<BvhRange>& tasks);
    void gatherTasks(std::vector<BvhRange>& tasks);
    std::vector<BvhNode> buildTask(const BvhRange& range);

    BvhInput& input_;
    const BvhSettings& settings_;
    const std::atomic<bool>* cancel_;
    std::atomic<std::uint64_t>* itemsDone_;
    const bool grouped_;
    const std::uint32_t firstGroup_;
    // Items, while the boxes stay where they are: copies of these would take several times the memory. A range is in
    // one of the orders, tasks are all in the first.
    std::vector<std::uint32_t> orders_[2];
};

BvhRange Builder::prepareItems() {
    const Chunks chunks(input_.boxes.size(), kChunkItems);
    std::vector<BvhRange> parts(chunks.count);
    parallelFor(settings_.threads, chunks.count, [&](std::size_t chunk) {
        BvhRange part;
        for (std::size_t i = chunks.begin(chunk); i < chunks.end(chunk); ++i) {
            orders_[0][i] = static_cast<std::uint32_t>(i);
            const Bounds box = boundsOf(input_.boxes[i]);
            part.box.add(box);
            part.centers.add(centerOf(box));
        }
        parts[chunk] = part;
    });
    BvhRange all;
    all.end = static_cast<std::uint32_t>(input_.boxes.size());
    for (const BvhRange& part : parts) {
        all.box.add(part.box);
        all.centers.add(part.centers);
    }
    return all;
}

// Divides a range by all threads together, from its order into the other; in half where no plane divides it.
void Builder::divideTogether(const BvhRange& range, std::vector<BvhNode>& nodes, std::vector<BvhRange>& large,
                             std::vector<BvhRange>& tasks) {
    const std::uint32_t* source = orders_[range.order].data() + range.begin;
    const auto boxAt = [&, last = range.size() - 1](std::size_t i) -> const Box& {
        prefetch(&input_.boxes[source[std::min<std::size_t>(i + kAhead, last)]]);
        return input_.boxes[source[i]];
    };
    std::uint32_t* target = orders_[1 - range.order].data() + range.begin;
    const Binning binning(range.centers, settings_.bins);
    const Chunks chunks(range.size(), kChunkItems);
    std::vector<BinSums> sums(chunks.count, BinSums(settings_.bins));
    BinSums total(settings_.bins);
    Split split;
    if (binning.hasExtent() && range.depth <= settings_.maxDepth / 2) {
        parallelFor(settings_.threads, chunks.count, [&](std::size_t chunk) {
            for (std::size_t i = chunks.begin(chunk); i < chunks.end(chunk); ++i) {
                const Bounds box = boundsOf(boxAt(i));
                sums[chunk].add(box, centerOf(box), binning);
            }
        });
        for (const BinSums& part : sums) {
            total.add(part);
        }
        split = total.best(settings_.blockSize);
    }
    BvhRange left, right;
    if (split.axis < 0) {
        const std::uint32_t lefts = range.size() / 2;
        for (std::uint32_t i = 0; i < range.size(); ++i) {
            const Bounds box = boundsOf(boxAt(i));
            BvhRange& side = i < lefts ? left : right;
            side.box.add(box);
            side.centers.add(centerOf(box));
        }
        range.divide(lefts, left, right);
        left.order = right.order = range.order;
    } else {
        std::vector<std::array<std::uint32_t, 2>> starts(chunks.count); // where a chunk's items go on either side
        std::uint32_t lefts = 0;
        for (std::size_t chunk = 0; chunk < chunks.count; ++chunk) {
            const std::uint32_t before = static_cast<std::uint32_t>(chunks.begin(chunk));
            starts[chunk] = {lefts, split.left + before - lefts};
            lefts += sums[chunk].itemsBelow(split.axis, split.bin);
        }
        std::vector<std::array<Bounds, 2>> centers(chunks.count, {Bounds::empty(), Bounds::empty()});
        parallelFor(settings_.threads, chunks.count, [&](std::size_t chunk) {
            std::array<std::uint32_t, 2> at = starts[chunk];
            std::array<Bounds, 2> own = centers[chunk];
            for (std::size_t i = chunks.begin(chunk); i < chunks.end(chunk); ++i) {
                const Bounds box = boundsOf(boxAt(i));
                const Float4 center = centerOf(box);
                std::int32_t bins[4];
                binning.bins(center, bins);
                const int side = bins[split.axis] < split.bin ? 0 : 1;
                own[side].add(center);
                target[at[side]++] = source[i];
            }
            centers[chunk] = own;
        });
        for (const auto& part : centers) {
            left.centers.add(part[0]);
            right.centers.add(part[1]);
        }
        left.box = total.bounds(split.axis, 0, split.bin);
        right.box = total.bounds(split.axis, split.bin, static_cast<std::int32_t>(settings_.bins));
        range.divide(split.left, left, right);
        left.order = right.order = 1 - range.order;
    }
    addChildren(nodes, range.node, left, right);
    for (const BvhRange& child : {left, right}) {
        (child.size() > kTaskItems ? large : tasks).push_back(child);
    }
}

// The second order goes before trees grow.
void Builder::gatherTasks(std::vector<BvhRange>& tasks) {
    for (BvhRange& task : tasks) {
        if (task.order == 1) std::copy_n(orders_[1].begin() + task.begin, task.size(), orders_[0].begin() + task.begin);
        task.order = 0;
    }
    release(orders_[1]);
}

std::vector<BvhNode> Builder::buildTask(const BvhRange& range) {
    std::vector<ItemBox> items;
    items.reserve(range.size());
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
        const std::uint32_t item = orders_[0][i];
        const Box& b = input_.boxes[item];
        items.push_back({{b.lower.x, b.lower.y, b.lower.z},
                         item,
                         {b.upper.x, b.upper.y, b.upper.z},
                         grouped_ ? input_.groups[item] : firstGroup_});
    }
    std::vector<BvhNode> nodes = BvhTask(settings_, grouped_, std::move(items)).build(range, orders_[0]);
    if (itemsDone_ != nullptr) itemsDone_->fetch_add(range.size(), std::memory_order_relaxed);
    return nodes;
}

std::optional<Bvh> Builder::build() {
    Bvh bvh;
    if (input_.boxes.empty()) return bvh;
    const std::size_t count = input_.boxes.size();
    for (std::vector<std::uint32_t>& order : orders_) resizeLarge(order, count);
    const BvhRange all = prepareItems();

    bvh.nodes.push_back({all.box.box(), 0, 0});
    std::vector<BvhRange> large, tasks;
    (all.size() > kTaskItems ? large : tasks).push_back(all);
    for (std::size_t i = 0; i < large.size(); ++i) {
        if (cancelled()) return std::nullopt;
        const BvhRange range = large[i];
        divideTogether(range, bvh.nodes, large, tasks);
    }
    gatherTasks(tasks);

    std::stable_sort(tasks.begin(), tasks.end(),
                     [](const BvhRange& a, const BvhRange& b) { return a.size() > b.size(); });
    std::vector<std::vector<BvhNode>> trees(tasks.size());
    parallelFor(settings_.threads, tasks.size(), [&](std::size_t i) {
        if (!cancelled()) trees[i] = buildTask(tasks[i]);
    });
    if (cancelled()) return std::nullopt;
    release(input_.boxes);

    std::vector<std::size_t> offsets(tasks.size()); // of a tree's second node; its root replaces the node of its task
    std::size_t total = bvh.nodes.size();
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        offsets[i] = total;
        total += trees[i].size() - 1;
    }
    resizeLarge(bvh.nodes, total);
    parallelFor(settings_.threads, tasks.size(), [&](std::size_t i) {
        for (std::size_t n = 0; n < trees[i].size(); ++n) {
            BvhNode node = trees[i][n];
            if (!node.isLeaf()) node.first = static_cast<std::uint32_t>(node.first - 1 + offsets[i]);
            bvh.nodes[n == 0 ? tasks[i].node : offsets[i] + n - 1] = node;
        }
    });
    bvh.items = std::move(orders_[0]);
    return bvh;
}

} // namespace

std::optional<Bvh> buildBvh(BvhInput input, const BvhSettings& settings, const std::atomic<bool>* cancel,
                            std::atomic<std::uint64_t>* itemsDone) {
    return Builder(input, settings, cancel, itemsDone).build();
}

} // namespace rt::accel
