#include "Common/Accel/Build/BvhTask.h"

namespace rt::accel {

std::optional<Division> BvhTask::choose(const BvhRange& range, const BinSums& sums, bool binned,
                                        bool isMixedLeaf) const {
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
bool BvhTask::isMixed(const BvhRange& range) const {
    for (std::uint32_t i = range.begin; grouped_ && i < range.end; ++i)
        if (items_[i].group != items_[range.begin].group) return true;
    return false;
}

// The range is not worth dividing by a plane: but a leaf must not be too large or hold items of two groups.
std::optional<Division> BvhTask::chooseForLeaf(const BvhRange& range) const {
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
void BvhTask::partition(const BvhRange& range, const Division& division, const Binning& binning, BvhRange& left,
                        BvhRange& right) {
    ItemBox* items = items_.data() + range.begin;
    left = right = BvhRange{};
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
        BvhRange& side = isLeft ? left : right;
        side.box.add(item.bounds());
        side.centers.add(item.center());
        lefts += isLeft ? 1 : 0;
        rights += isLeft ? 0 : 1;
    }
    std::copy_n(scratch_.get(), rights, items + lefts);
    range.divide(lefts, left, right);
}

std::vector<BvhNode> BvhTask::build(const BvhRange& range, std::vector<std::uint32_t>& order) {
    std::vector<BvhNode> nodes;
    nodes.reserve(range.size() / 2 + 1);
    nodes.push_back({range.box.box(), 0, 0});
    std::vector<BvhRange> open{range};
    open.back().begin = open.back().node = 0;
    open.back().end = range.size();
    while (!open.empty()) {
        const BvhRange next = open.back();
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
        BvhRange left, right;
        partition(next, *division, binning, left, right);
        addChildren(nodes, next.node, left, right);
        open.push_back(right);
        open.push_back(left);
    }
    return nodes;
}

} // namespace rt::accel
