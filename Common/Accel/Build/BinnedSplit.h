// One step of BvhBuilder: which plane divides a range of items best, and the division itself.
#pragma once
#include <array>
#include <cstdint>

#include "Common/Accel/Simd/Float4.h"

namespace rt::accel {

inline constexpr std::uint32_t kMaxBins = 32;

// The box of an item, with its index and group in the fourth lanes.
struct alignas(32) ItemBox {
    float lower[3];
    std::uint32_t item;
    float upper[3];
    std::uint32_t group;

    Bounds bounds() const { return {Float4::load(lower), Float4::load(upper)}; }
    // Twice the centre. The index and the group, read as floats, would be denormal and slow to add.
    Float4 center() const { return Float4::load3(lower) + Float4::load3(upper); }
};

// A box as ItemBox::bounds() gives an item's; the fourth lanes are 0.
inline Bounds boundsOf(const Box& box) {
    static_assert(sizeof(Box) == 6 * sizeof(float));
    return {Float4::load3(&box.lower.x), Float4::loadLast3(&box.lower.z)};
}

// Maps twice the centre of an item to one of `count` bins along each axis; an axis without extent has bin 0 only.
class Binning {
  public:
    Binning() = default;
    Binning(const Bounds& centers, std::uint32_t count);

    std::uint32_t count() const { return count_; }
    void bins(Float4 center, std::int32_t (&result)[4]) const { ((center - base_) * scale_).storeInts(result); }
    bool hasExtent() const { return hasExtent_; }

  private:
    Float4 base_{0.0f};
    Float4 scale_{0.0f};
    std::uint32_t count_ = 0;
    bool hasExtent_ = false;
};

struct Split {
    float cost = 0;         // sum over both sides of half area times blocks
    int axis = -1;          // -1: no plane has items on both sides
    std::int32_t bin = 0;   // items in lower bins go to the left
    std::uint32_t left = 0; // items on the left
};

// What the bins of a range hold.
class BinSums {
  public:
    explicit BinSums(std::uint32_t count);
    // An item; `center` as in ItemBox.
    void add(const Bounds& bounds, Float4 center, const Binning& binning) {
        std::int32_t bin[4];
        binning.bins(center, bin);
        for (int a = 0; a < 3; ++a) {
            bounds_[a][bin[a]].add(bounds);
            ++items_[a][bin[a]];
        }
    }
    void add(const BinSums& other);
    Split best(std::uint32_t blockSize) const;
    std::uint32_t itemsBelow(int axis, std::int32_t bin) const;
    Bounds bounds(int axis, std::int32_t begin, std::int32_t end) const;

  private:
    std::uint32_t count_;
    std::array<std::array<Bounds, kMaxBins>, 3> bounds_;
    std::array<std::array<std::uint32_t, kMaxBins>, 3> items_;
};

} // namespace rt::accel
