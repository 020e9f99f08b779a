// One channel of an image, and means over squares of pixels.
#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <span>

namespace rt::image {

// Planes of one size share memory: the system gives it in large pages, and that of planes that are gone is used again,
// as fresh pages take longer than to fill them.
class Plane {
  public:
    Plane() = default;
    Plane(std::size_t width, std::size_t height); // of zeros
    Plane(Plane&&) = default;                     // not copied: both would have the same pixels
    Plane& operator=(Plane&&) = default;
    // One of the same size, by the same memory; of any values.
    Plane alike() const;

    std::size_t width() const { return width_; }
    std::size_t height() const { return height_; }
    float* row(std::size_t y) { return data_.get() + y * width_; }
    const float* row(std::size_t y) const { return data_.get() + y * width_; }

  private:
    class Memory;
    Plane(std::size_t width, std::size_t height, std::shared_ptr<Memory> memory);

    std::size_t width_ = 0, height_ = 0;
    std::shared_ptr<Memory> memory_;
    std::shared_ptr<float> data_; // goes back to it
};

using Planes = std::array<Plane, 3>;

// Adds values[x + shift] to sums[x], for all x of a row where both are in it.
void addShifted(const float* values, std::ptrdiff_t shift, std::size_t width, float* __restrict sums);

// Of each plane: the mean over the pixels of the image in the square of side 2 reach + 1 around each.
void boxMeans(std::span<Plane> planes, int reach, std::size_t threads);

} // namespace rt::image
