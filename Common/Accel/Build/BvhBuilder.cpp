#include "Common/Accel/Build/BvhBuilder.h"

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "Common/Accel/Build/BinnedSplit.h"
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

struct Range {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::uint32_t node = 0;
    std::uint32_t depth = 0;
    int order = 0; // which of the orders its items are in; of no meaning within a task
    Bounds box = Bounds::empty();
    Bounds centers = Bounds::empty(); // of ItemBox::center()

    std::uint32_t size() const { return end - begin; }
    // The two ranges that it is divided into.
    void divide(std::uint32_t lefts, Range& left, Range& right) const {
        left.begin = begin;
        left.end = right.begin = begin + lefts;
        right.end = end;
        left.depth = right.depth = depth + 1;
    }
};

// As ItemBox::center(): twice the centre.
Float4 centerOf(const Bounds& box) {
    return box.lower + box.upper;
}

// Adds two children to node `parent` and names them in the ranges.
void addChildren(std::vector<BvhNode>& nodes, std::uint32_t parent, Range& left, Range& right) {
    left.node = static_cast<std::uint32_t>(nodes.size());
    right.node = left.node + 1;
    nodes[parent].first = left.node;
    nodes[parent].count = 0;
    nodes.push_back({left.box.box(), 0, 0});
    nodes.push_back({right.box.box(), 0, 0});
}

// ---- small ranges --------------------------------------------------------------------------------------------------

// Where items go when a range is divided: the first `left` in the order of a plane, of a group, or as they stand.
struct Division {
    enum class By { Plane, Group, Count } by = By::Plane;
    Split split;
    std::uint32_t group = 0;
};

// The tree of a range, built by one thread from copies of its boxes, which a core's own cache holds.
class Task {
  public:
    Task(const BvhSettings& settings, bool grouped, std::vector<ItemBox> items)
        : settings_(settings),
          grouped_(grouped),
          items_(std::move(items)),
          scratch_(std::make_unique_for_overwrite<ItemBox[]>(items_.size())) {}

    // Leaves name places in `order`, which gets the items, from `range.begin` on.
    std::vector<BvhNode> build(const Range& range, std::vector<std::uint32_t>& order);

  private:
    std::uint32_t binCount(std::uint32_t items) const { return std::min(settings_.bins, 4 + items / 8); }
    bool isMixed(const Range& range) const;
    // The plane to divide at; by count where no plane helps; nothing if the range is to be a leaf.
    std::optional<Division> choose(const Range& range, const BinSums& sums, bool binned, bool isMixedLeaf) const;
    std::optional<Division> chooseForLeaf(const Range& range) const;
    void partition(const Range& range, const Division& division, const Binning& binning, Range& left, Range& right);

    const BvhSettings& settings_;
    const bool grouped_;
    std::vector<ItemBox> items_;
    const std::unique_ptr<ItemBox[]> scratch_; // as many
};

std::optional<Division> Task::choose(const Range& range, const BinSums& sums, bool binned, bool isMixedLeaf) const {
    if (range.depth > settings_.maxDepth / 2) return chooseForLeaf(range);
    Division division;
    if (binned) division.split = sums.best(isMixedLeaf ? 1 : settings_.blockSize);
    if (division.split.axis < 0) return chooseForLeaf(range);
    if (range.size() <= settings_.maxLeafSize && !isMixedLeaf) {
        const float area = range.box.halfArea();
        const std::size_t blocks = (range.size() + settings_.blockSize - 1) / settings_.blockSize;
        if (area * static_cast<float>(blocks) <= area * settings_.nodeCost + division.split.cost)
            return chooseForLeaf(range);
    }
    return division;
}

// Whether items of several groups are in the range.
bool Task::isMixed(const Range& range) const {
    for (std::uint32_t i = range.begin; grouped_ && i < range.end; ++i)
        if (items_[i].group != items_[range.begin].group) return true;
    return false;
}

// The range is not worth dividing by a plane: but a leaf must not be too large or hold items of two groups.
std::optional<Division> Task::chooseForLeaf(const Range& range) const {
    Division division;
    if (range.size() > settings_.maxLeafSize) {
        division.by = Division::By::Count;
        return division;
    }
    for (std::uint32_t i = range.begin; grouped_ && i < range.end; ++i) {
        if (items_[i].group != items_[range.begin].group) {
            division.by = Division::By::Group;
            division.group = items_[range.begin].group;
            return division;
        }
    }
    if (range.size() == 1 || items_[range.begin].group != settings_.singleGroup) return std::nullopt;
    division.by = Division::By::Count;
    return division;
}

// Items stay in their order on the left, and on the right.
void Task::partition(const Range& range, const Division& division, const Binning& binning, Range& left, Range& right) {
    ItemBox* items = items_.data() + range.begin;
    left = right = Range{};
    std::uint32_t lefts = 0, rights = 0;
    for (std::uint32_t i = 0; i < range.size(); ++i) {
        const ItemBox item = items[i];
        bool isLeft = i < range.size() / 2;
        if (division.by == Division::By::Plane) {
            std::int32_t bins[4];
            binning.bins(item.center(), bins);
            isLeft = bins[division.split.axis] < division.split.bin;
        } else if (division.by == Division::By::Group) {
            isLeft = item.group == division.group;
        }
        items[lefts] = item;
        scratch_[rights] = item;
        Range& side = isLeft ? left : right;
        side.box.add(item.bounds());
        side.centers.add(item.center());
        lefts += isLeft ? 1 : 0;
        rights += isLeft ? 0 : 1;
    }
    std::copy_n(scratch_.get(), rights, items + lefts);
    range.divide(lefts, left, right);
}

std::vector<BvhNode> Task::build(const Range& range, std::vector<std::uint32_t>& order) {
    std::vector<BvhNode> nodes;
    nodes.reserve(range.size() / 2 + 1);
    nodes.push_back({range.box.box(), 0, 0});
    std::vector<Range> open{range};
    open.back().begin = open.back().node = 0;
    open.back().end = range.size();
    while (!open.empty()) {
        const Range next = open.back();
        open.pop_back();
        std::optional<Division> division;
        Binning binning;
        const bool isMixedLeaf = next.size() <= settings_.blockSize && isMixed(next);
        if (next.size() <= settings_.blockSize && !isMixedLeaf) {
            division = chooseForLeaf(next);
        } else {
            const std::uint32_t bins = binCount(next.size());
            binning = Binning(next.centers, bins);
            BinSums sums(bins);
            for (std::uint32_t i = next.begin; binning.hasExtent() && i < next.end; ++i)
                sums.add(items_[i].bounds(), items_[i].center(), binning);
            division = choose(next, sums, binning.hasExtent(), isMixedLeaf);
        }
        if (!division) {
            std::uint32_t* leaf = order.data() + range.begin + next.begin;
            for (std::uint32_t i = 0; i < next.size(); ++i) leaf[i] = items_[next.begin + i].item;
            std::sort(leaf, leaf + next.size());
            nodes[next.node].first = range.begin + next.begin;
            nodes[next.node].count = next.size();
            continue;
        }
        Range left, right;
        partition(next, *division, binning, left, right);
        addChildren(nodes, next.node, left, right);
        open.push_back(right);
        open.push_back(left);
    }
    return nodes;
}

// ---- large ranges --------------------------------------------------------------------------------------------------

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
    Range prepareItems();
    void divideTogether(const Range& range, std::vector<BvhNode>& nodes, std::vector<Range>& large,
                        std::vector<Range>& tasks);
    void gatherTasks(std::vector<Range>& tasks);
    std::vector<BvhNode> buildTask(const Range& range);

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

Range Builder::prepareItems() {
    const Chunks chunks(input_.boxes.size(), kChunkItems);
    std::vector<Range> parts(chunks.count);
    parallelFor(settings_.threads, chunks.count, [&](std::size_t chunk) {
        Range part;
        for (std::size_t i = chunks.begin(chunk); i < chunks.end(chunk); ++i) {
            orders_[0][i] = static_cast<std::uint32_t>(i);
            const Bounds box = boundsOf(input_.boxes[i]);
            part.box.add(box);
            part.centers.add(centerOf(box));
        }
        parts[chunk] = part;
    });
    Range all;
    all.end = static_cast<std::uint32_t>(input_.boxes.size());
    for (const Range& part : parts) {
        all.box.add(part.box);
        all.centers.add(part.centers);
    }
    return all;
}

// Divides a range by all threads together, from its order into the other; in half where no plane divides it.
void Builder::divideTogether(const Range& range, std::vector<BvhNode>& nodes, std::vector<Range>& large,
                             std::vector<Range>& tasks) {
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
    Range left, right;
    if (split.axis < 0) {
        const std::uint32_t lefts = range.size() / 2;
        for (std::uint32_t i = 0; i < range.size(); ++i) {
            const Bounds box = boundsOf(boxAt(i));
            Range& side = i < lefts ? left : right;
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
    for (const Range& child : {left, right}) {
        (child.size() > kTaskItems ? large : tasks).push_back(child);
    }
}

// The second order goes before trees grow.
void Builder::gatherTasks(std::vector<Range>& tasks) {
    for (Range& task : tasks) {
        if (task.order == 1) std::copy_n(orders_[1].begin() + task.begin, task.size(), orders_[0].begin() + task.begin);
        task.order = 0;
    }
    release(orders_[1]);
}

std::vector<BvhNode> Builder::buildTask(const Range& range) {
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
    std::vector<BvhNode> nodes = Task(settings_, grouped_, std::move(items)).build(range, orders_[0]);
    if (itemsDone_ != nullptr) itemsDone_->fetch_add(range.size(), std::memory_order_relaxed);
    return nodes;
}

std::optional<Bvh> Builder::build() {
    Bvh bvh;
    if (input_.boxes.empty()) return bvh;
    const std::size_t count = input_.boxes.size();
    for (std::vector<std::uint32_t>& order : orders_) resizeLarge(order, count);
    const Range all = prepareItems();

    bvh.nodes.push_back({all.box.box(), 0, 0});
    std::vector<Range> large, tasks;
    (all.size() > kTaskItems ? large : tasks).push_back(all);
    for (std::size_t i = 0; i < large.size(); ++i) {
        if (cancelled()) return std::nullopt;
        const Range range = large[i];
        divideTogether(range, bvh.nodes, large, tasks);
    }
    gatherTasks(tasks);

    std::stable_sort(tasks.begin(), tasks.end(), [](const Range& a, const Range& b) { return a.size() > b.size(); });
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
