// One channel of an image in a block of its own, and means over squares of pixels.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace rt::image {

class Plane {
  public:
    Plane() = default;
    Plane(std::size_t width, std::size_t height) : width_(width), height_(height), data_(width * height) {}

    std::size_t width() const { return width_; }
    std::size_t height() const { return height_; }
    float* row(std::size_t y) { return data_.data() + y * width_; }
    const float* row(std::size_t y) const { return data_.data() + y * width_; }

  private:
    std::size_t width_ = 0, height_ = 0;
    std::vector<float> data_;
};

using Planes = std::array<Plane, 3>;

// The pixels of an image of this size, from first to last, that are at most `reach` from one in one direction.
struct InReach {
    std::size_t first, last;
    InReach(std::size_t at, std::size_t reach, std::size_t size)
        : first(at < reach ? 0 : at - reach), last(std::min(at + reach, size - 1)) {}
    std::size_t count() const { return last - first + 1; }
    bool contains(std::size_t at) const { return at >= first && at <= last; }
};

// The mean over the pixels of the image in the square of side 2 reach + 1 around each.
Plane boxMean(const Plane& plane, int reach, std::size_t threads);

} // namespace rt::image
