#include "Common/App/Interactive/Draft.h"

#include <algorithm>
#include <vector>

namespace rt::app {
namespace {

// Reads an image at the pixels of a larger one.
class Enlarged {
  public:
    Enlarged(const image::Image& image, std::uint32_t width, std::uint32_t height)
        : image_(image), columns_(places(image.width, width)), rows_(places(image.height, height)) {}

    void read(std::uint32_t x, std::uint32_t y, float* value) const {
        const Place& column = columns_[x];
        const Place& row = rows_[y];
        const float* upper = image_.pixel(0, row.first);
        const float* lower = image_.pixel(0, row.second);
        const std::size_t left = std::size_t{column.first} * image_.channels;
        const std::size_t right = std::size_t{column.second} * image_.channels;
        for (std::size_t c = 0; c < image_.channels; ++c) {
            const float top = mix(upper[left + c], upper[right + c], column.weight);
            const float bottom = mix(lower[left + c], lower[right + c], column.weight);
            value[c] = mix(top, bottom, row.weight);
        }
    }

  private:
    // Between which two of the small image's columns or rows one of the large image's lies.
    struct Place {
        std::uint32_t first, second;
        float weight; // of the second
    };

    static std::vector<Place> places(std::uint32_t small, std::uint32_t large) {
        std::vector<Place> result(large);
        const float scale = static_cast<float>(small) / static_cast<float>(large);
        for (std::uint32_t i = 0; i < large; ++i) {
            const float at = std::max(0.0f, (static_cast<float>(i) + 0.5f) * scale - 0.5f);
            const std::uint32_t first = std::min(static_cast<std::uint32_t>(at), small - 1);
            result[i] = {first, std::min(first + 1, small - 1), at - static_cast<float>(first)};
        }
        return result;
    }

    static float mix(float a, float b, float weight) { return a + weight * (b - a); }

    const image::Image& image_;
    std::vector<Place> columns_, rows_;
};

} // namespace

image::Image enlarge(const image::Image& image, std::uint32_t width, std::uint32_t height) {
    if (width == image.width && height == image.height) return image;
    image::Image result(width, height, image.channels);
    const Enlarged source(image, width, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) source.read(x, y, result.pixel(x, y));
    return result;
}

void fillFromDraft(image::Image& picture, std::span<const std::uint64_t> tileSamples, const image::Image& draft) {
    const Enlarged source(draft, picture.width, picture.height);
    constexpr std::uint32_t kTile = image::Film::kTile;
    const std::uint32_t tilesX = (picture.width + kTile - 1) / kTile;
    for (std::uint32_t tile = 0; tile < tileSamples.size(); ++tile) {
        if (tileSamples[tile] > 0) continue;
        const std::uint32_t x0 = tile % tilesX * kTile;
        const std::uint32_t y0 = tile / tilesX * kTile;
        for (std::uint32_t y = y0; y < std::min(y0 + kTile, picture.height); ++y)
            for (std::uint32_t x = x0; x < std::min(x0 + kTile, picture.width); ++x)
                source.read(x, y, picture.pixel(x, y));
    }
}

} // namespace rt::app
