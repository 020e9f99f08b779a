#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace rt::image {

// Linear radiance (or any other quantity), channel-interleaved, rows from the top.
struct Image {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t channels = 3;
    std::vector<float> data; // width * height * channels

    Image() = default;
    Image(std::uint32_t w, std::uint32_t h, std::uint32_t c = 3); // of zeros

    float* pixel(std::uint32_t x, std::uint32_t y) { return &data[(std::size_t{y} * width + x) * channels]; }
    const float* pixel(std::uint32_t x, std::uint32_t y) const {
        return &data[(std::size_t{y} * width + x) * channels];
    }
};

} // namespace rt::image
