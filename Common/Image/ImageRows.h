// An image that is made a row at a time while it is written: no second copy of it needs memory.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "Common/Image/Image.h"

namespace rt::image {

struct ImageRows {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t channels = 3;
    // Fills row y, counted from the top, with width * channels values. Any row may be asked for at any time, and again,
    // and by several threads at a time but where its maker says otherwise.
    std::function<void(std::uint32_t y, std::span<float> row)> read;

    ImageRows() = default;
    ImageRows(std::uint32_t w, std::uint32_t h, std::uint32_t c,
              std::function<void(std::uint32_t, std::span<float>)> readRow)
        : width(w), height(h), channels(c), read(std::move(readRow)) {}
    ImageRows(const Image& image); // which must outlive this

    std::size_t rowValues() const { return std::size_t{width} * channels; }
};

// All rows, read by so many threads at a time (0: all of the machine), into an image of their size or a new one.
void readInto(Image& image, const ImageRows& rows, std::size_t threads);
Image toImage(const ImageRows& rows, std::size_t threads = 1);

// The same image with every value changed; `change` is called for one value at a time.
ImageRows mapped(ImageRows rows, std::function<float(float)> change);

} // namespace rt::image
