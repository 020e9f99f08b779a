#include "Common/Accel/Build/BinnedSplit.h"

#include <algorithm>

namespace rt::accel {

namespace {

std::uint32_t blockCount(std::uint32_t items, std::uint32_t blockSize) { // the last one perhaps in part
    return (items + blockSize - 1) / blockSize;
}

} // namespace

Binning::Binning(const Bounds& centers, std::uint32_t count) : base_(centers.lower), count_(count) {
    float extent[4];
    (centers.upper - centers.lower).store(extent);
    float scale[3];
    for (int a = 0; a < 3; ++a) {
        // A little less than count / extent, so that the last centre falls into the last bin.
        const float s = static_cast<float>(count) * 0.999999f / extent[a];
        scale[a] = extent[a] > 0.0f && s < std::numeric_limits<float>::infinity() ? s : 0.0f;
        hasExtent_ = hasExtent_ || scale[a] > 0.0f;
    }
    scale_ = Float4(scale[0], scale[1], scale[2], 0.0f);
}

BinSums::BinSums(std::uint32_t count) : count_(count) {
    for (int a = 0; a < 3; ++a) {
        std::fill_n(bounds_[a].begin(), count, Bounds::empty());
        std::fill_n(items_[a].begin(), count, 0u);
    }
}

void BinSums::add(const BinSums& other) {
    for (int a = 0; a < 3; ++a) {
        for (std::uint32_t i = 0; i < count_; ++i) {
            bounds_[a][i].add(other.bounds_[a][i]);
            items_[a][i] += other.items_[a][i];
        }
    }
}

Split BinSums::best(std::uint32_t blockSize) const {
    Split best;
    best.cost = std::numeric_limits<float>::infinity();
    for (int a = 0; a < 3; ++a) {
        float rightCost[kMaxBins]; // of all items in bins i and up
        std::uint32_t items = 0;
        Bounds right = Bounds::empty();
        for (std::uint32_t i = count_ - 1; i > 0; --i) {
            items += items_[a][i];
            right.add(bounds_[a][i]);
            rightCost[i] = items == 0 ? -1.0f : right.halfArea() * static_cast<float>(blockCount(items, blockSize));
        }
        items = 0;
        Bounds left = Bounds::empty();
        for (std::uint32_t i = 1; i < count_; ++i) {
            items += items_[a][i - 1];
            left.add(bounds_[a][i - 1]);
            if (items == 0 || rightCost[i] < 0.0f) continue;
            const float cost = left.halfArea() * static_cast<float>(blockCount(items, blockSize)) + rightCost[i];
            if (cost < best.cost) best = {cost, a, static_cast<std::int32_t>(i), items};
        }
    }
    return best;
}

std::uint32_t BinSums::itemsBelow(int axis, std::int32_t bin) const {
    std::uint32_t items = 0;
    for (std::int32_t i = 0; i < bin; ++i) {
        items += items_[axis][i];
    }
    return items;
}

Bounds BinSums::bounds(int axis, std::int32_t begin, std::int32_t end) const {
    Bounds result = Bounds::empty();
    for (std::int32_t i = begin; i < end; ++i) {
        result.add(bounds_[axis][i]);
    }
    return result;
}

} // namespace rt::accel
