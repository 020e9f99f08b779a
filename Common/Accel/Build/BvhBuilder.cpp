#include "Common/Accel/Build/BvhBuilder.h"

#include <algorithm>
#include <bit>
#include <vector>

#include "Common/Accel/Build/BinnedSplit.h"
#include "Common/Core/Parallel.h"
#include "Common/Core/SystemMemory.h"

namespace rt::accel {
namespace {

// Ranges above this many items are divided by all threads together, one after the other; those below are trees of their
// own, each built by one thread. Part of the result: it must not depend on the machine.
constexpr std::uint32_t kTaskItems = 1u << 14;
constexpr std::size_t kChunkItems = 1u << 13;

struct Range {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::uint32_t node = 0;
    std::uint32_t depth = 0;
    int buffer = 0; // where its items are
    Bounds box = Bounds::empty();
    Bounds centers = Bounds::empty(); // of ItemBox::center()

    std::uint32_t size() const { return end - begin; }
};

// Where items go when a range is divided: the first `left` in the order of a plane, of a group, or as they stand.
struct Division {
    enum class By { Plane, Group, Count } by = By::Plane;
    Split split;
    std::uint32_t group = 0;
};

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
    void buildTask(const Range& range, std::vector<BvhNode>& nodes);

    std::uint32_t binCount(std::uint32_t items) const;
    bool isMixed(const Range& range) const;
    // The plane to divide at; by count where no plane helps; nothing if the range is to be a leaf.
    std::optional<Division> choose(const Range& range, const BinSums& sums, bool binned, bool isMixedLeaf) const;
    std::optional<Division> chooseForLeaf(const Range& range) const;
    void partition(const Range& range, const Division& division, const Binning& binning, ItemBox* scratch, Range& left,
                   Range& right);
    void gatherTasks(std::vector<Range>& tasks);
    void makeLeaf(const Range& range, std::vector<BvhNode>& nodes);

    BvhInput& input_;
    const BvhSettings& settings_;
    const std::atomic<bool>* cancel_;
    std::atomic<std::uint64_t>* itemsDone_;
    const bool grouped_;
    const std::uint32_t firstGroup_;
    std::vector<ItemBox> buffers_[2]; // a range lies in one of them; those of tasks all in the first
    std::vector<std::uint32_t> items_;
};

Range Builder::prepareItems() {
    const Chunks chunks(input_.boxes.size(), kChunkItems);
    std::vector<Range> parts(chunks.count);
    parallelFor(settings_.threads, chunks.count, [&](std::size_t chunk) {
        Range part;
        for (std::size_t i = chunks.begin(chunk); i < chunks.end(chunk); ++i) {
            const Box& b = input_.boxes[i];
            ItemBox& item = buffers_[0][i];
            item = {{b.lower.x, b.lower.y, b.lower.z},
                    static_cast<std::uint32_t>(i),
                    {b.upper.x, b.upper.y, b.upper.z},
                    grouped_ ? input_.groups[i] : firstGroup_};
            part.box.add(item.bounds());
            part.centers.add(item.center());
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

std::uint32_t Builder::binCount(std::uint32_t items) const {
    return std::min(settings_.bins, 4 + items / 8);
}

std::optional<Division> Builder::choose(const Range& range, const BinSums& sums, bool binned, bool isMixedLeaf) const {
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
bool Builder::isMixed(const Range& range) const {
    const ItemBox* items = buffers_[range.buffer].data();
    for (std::uint32_t i = range.begin; grouped_ && i < range.end; ++i)
        if (items[i].group != items[range.begin].group) return true;
    return false;
}

// The range is not worth dividing by a plane: but a leaf must not be too large or hold items of two groups.
std::optional<Division> Builder::chooseForLeaf(const Range& range) const {
    Division division;
    if (range.size() > settings_.maxLeafSize) {
        division.by = Division::By::Count;
        return division;
    }
    const ItemBox* items = buffers_[range.buffer].data();
    for (std::uint32_t i = range.begin; grouped_ && i < range.end; ++i) {
        if (items[i].group != items[range.begin].group) {
            division.by = Division::By::Group;
            division.group = items[range.begin].group;
            return division;
        }
    }
    if (range.size() == 1 || items[range.begin].group != settings_.singleGroup) return std::nullopt;
    division.by = Division::By::Count;
    return division;
}

// Divides within one thread; items stay in their order on the left, and on the right. Scratch is as long as the range.
void Builder::partition(const Range& range, const Division& division, const Binning& binning, ItemBox* scratch,
                        Range& left, Range& right) {
    ItemBox* items = buffers_[range.buffer].data() + range.begin;
    left = right = Range{};
    left.buffer = right.buffer = range.buffer;
    left.depth = right.depth = range.depth + 1;
    std::uint32_t lefts = 0, rights = 0;
    for (std::uint32_t i = 0; i < range.size(); ++i) {
        const ItemBox item = items[i];
        bool isLeft = i < range.size() / 2;
        if (division.by == Division::By::Plane) {
            std::int32_t bins[4];
            binning.bins(item, bins);
            isLeft = bins[division.split.axis] < division.split.bin;
        } else if (division.by == Division::By::Group) {
            isLeft = item.group == division.group;
        }
        items[lefts] = item;
        scratch[rights] = item;
        Range& side = isLeft ? left : right;
        side.box.add(item.bounds());
        side.centers.add(item.center());
        lefts += isLeft ? 1 : 0;
        rights += isLeft ? 0 : 1;
    }
    std::copy_n(scratch, rights, items + lefts);
    left.begin = range.begin;
    left.end = right.begin = range.begin + lefts;
    right.end = range.end;
}

void Builder::makeLeaf(const Range& range, std::vector<BvhNode>& nodes) {
    const ItemBox* items = buffers_[range.buffer].data();
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
        items_[i] = items[i].item;
    }
    std::sort(items_.begin() + range.begin, items_.begin() + range.end);
    nodes[range.node].first = range.begin;
    nodes[range.node].count = range.size();
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

void Builder::buildTask(const Range& task, std::vector<BvhNode>& nodes) {
    nodes.reserve(task.size() / 2 + 1);
    nodes.push_back({task.box.box(), 0, 0});
    std::vector<ItemBox> scratch(task.size());
    std::vector<Range> open{task};
    open.back().node = 0;
    while (!open.empty()) {
        const Range range = open.back();
        open.pop_back();
        std::optional<Division> division;
        Binning binning;
        const bool isMixedLeaf = range.size() <= settings_.blockSize && isMixed(range);
        if (range.size() <= settings_.blockSize && !isMixedLeaf) {
            division = chooseForLeaf(range);
        } else {
            const std::uint32_t bins = binCount(range.size());
            binning = Binning(range.centers, bins);
            BinSums sums(bins);
            if (binning.hasExtent()) sums.add(buffers_[range.buffer].data() + range.begin, range.size(), binning);
            division = choose(range, sums, binning.hasExtent(), isMixedLeaf);
        }
        if (!division) {
            makeLeaf(range, nodes);
            continue;
        }
        Range left, right;
        partition(range, *division, binning, scratch.data(), left, right);
        addChildren(nodes, range.node, left, right);
        open.push_back(right);
        open.push_back(left);
    }
    if (itemsDone_ != nullptr) itemsDone_->fetch_add(task.size(), std::memory_order_relaxed);
}

// Divides a range by all threads together, from its buffer into the other.
void Builder::divideTogether(const Range& range, std::vector<BvhNode>& nodes, std::vector<Range>& large,
                             std::vector<Range>& tasks) {
    const ItemBox* source = buffers_[range.buffer].data() + range.begin;
    ItemBox* target = buffers_[1 - range.buffer].data() + range.begin;
    const Binning binning(range.centers, settings_.bins);
    const Chunks chunks(range.size(), kChunkItems);
    std::vector<BinSums> sums(chunks.count, BinSums(settings_.bins));
    if (binning.hasExtent()) {
        parallelFor(settings_.threads, chunks.count, [&](std::size_t chunk) {
            sums[chunk].add(source + chunks.begin(chunk), chunks.end(chunk) - chunks.begin(chunk), binning);
        });
    }
    BinSums total(settings_.bins);
    for (const BinSums& part : sums) {
        total.add(part);
    }
    const std::optional<Division> division = choose(range, total, binning.hasExtent(), false);
    Range left, right;
    if (!division || division->by != Division::By::Plane) {
        partition(range, division.value_or(Division{Division::By::Count, {}, 0}), binning, target, left, right);
    } else {
        const Split& split = division->split;
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
                std::int32_t bins[4];
                binning.bins(source[i], bins);
                const int side = bins[split.axis] < split.bin ? 0 : 1;
                own[side].add(source[i].center());
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
        left.begin = range.begin;
        left.end = right.begin = range.begin + split.left;
        right.end = range.end;
        left.buffer = right.buffer = 1 - range.buffer;
        left.depth = right.depth = range.depth + 1;
    }
    addChildren(nodes, range.node, left, right);
    for (const Range& child : {left, right}) {
        (child.size() > kTaskItems ? large : tasks).push_back(child);
    }
}

// The second buffer goes before trees grow.
void Builder::gatherTasks(std::vector<Range>& tasks) {
    parallelFor(settings_.threads, tasks.size(), [&](std::size_t i) {
        Range& task = tasks[i];
        if (task.buffer == 1)
            std::copy_n(buffers_[1].begin() + task.begin, task.size(), buffers_[0].begin() + task.begin);
        task.buffer = 0;
    });
    release(buffers_[1]);
}

std::optional<Bvh> Builder::build() {
    Bvh bvh;
    if (input_.boxes.empty()) return bvh;
    const std::size_t count = input_.boxes.size();
    resizeLarge(buffers_[0], count);
    const Range all = prepareItems();
    release(input_.boxes);
    resizeLarge(buffers_[1], count);

    bvh.nodes.push_back({all.box.box(), 0, 0});
    std::vector<Range> large, tasks;
    (all.size() > kTaskItems ? large : tasks).push_back(all);
    for (std::size_t i = 0; i < large.size(); ++i) {
        if (cancelled()) return std::nullopt;
        const Range range = large[i];
        divideTogether(range, bvh.nodes, large, tasks);
    }

    gatherTasks(tasks);
    resizeLarge(items_, count);

    std::stable_sort(tasks.begin(), tasks.end(), [](const Range& a, const Range& b) { return a.size() > b.size(); });
    std::vector<std::vector<BvhNode>> trees(tasks.size());
    parallelFor(settings_.threads, tasks.size(), [&](std::size_t i) {
        if (!cancelled()) buildTask(tasks[i], trees[i]);
    });
    if (cancelled()) return std::nullopt;
    release(buffers_[0]);

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
    bvh.items = std::move(items_);
    return bvh;
}

} // namespace

std::optional<Bvh> buildBvh(BvhInput input, const BvhSettings& settings, const std::atomic<bool>* cancel,
                            std::atomic<std::uint64_t>* itemsDone) {
    return Builder(input, settings, cancel, itemsDone).build();
}

} // namespace rt::accel
