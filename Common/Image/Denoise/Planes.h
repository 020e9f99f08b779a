// One channel of an image in a block of its own, and means over squares of pixels.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>

namespace rt::image {

class Plane {
  public:
    Plane() = default;
    Plane(std::size_t width, std::size_t height); // of zeros
    Plane(Plane&&) = default;                     // not copied: both would have the same pixels
    Plane& operator=(Plane&&) = default;

    std::size_t width() const { return width_; }
    std::size_t height() const { return height_; }
    float* row(std::size_t y) { return data_.get() + y * width_; }
    const float* row(std::size_t y) const { return data_.get() + y * width_; }

  private:
    friend class PlaneBlock;
    Plane(std::size_t width, std::size_t height, std::shared_ptr<float> data)
        : width_(width), height_(height), data_(std::move(data)) {}

    std::size_t width_ = 0, height_ = 0;
    std::shared_ptr<float> data_; // of a block that planes may share
};

// Memory for `count` planes of one size, of zeros, which lives as long as any of these. The system gives it in large
// pages, and when it is first written, so to all threads that fill it: planes apart from each other took much of the
// denoiser's time for pages alone.
class PlaneBlock {
  public:
    PlaneBlock(std::size_t width, std::size_t height, std::size_t count);
    Plane next();

  private:
    std::size_t width_, height_, left_;
    std::shared_ptr<float> next_;
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

// Adds values[x + shift] to sums[x], for all x of a row where both are in it.
void addShifted(const float* values, std::ptrdiff_t shift, std::size_t width, float* __restrict sums);

// Of each plane: the mean over the pixels of the image in the square of side 2 reach + 1 around each.
void boxMeans(std::span<Plane> planes, int reach, std::size_t threads);

} // namespace rt::image
