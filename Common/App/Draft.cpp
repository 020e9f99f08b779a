#include "Common/App/Draft.h"

#include <algorithm>
#include <cmath>

namespace rt::app {
namespace {

// Reads an image at the pixels of a larger one.
class Enlarged {
  public:
    Enlarged(const image::Image& image, std::uint32_t width, std::uint32_t height)
        : image_(image),
          scaleX_(static_cast<float>(image.width) / static_cast<float>(width)),
          scaleY_(static_cast<float>(image.height) / static_cast<float>(height)) {}

    void read(std::uint32_t x, std::uint32_t y, float* value) const {
        const float fx = std::max(0.0f, (static_cast<float>(x) + 0.5f) * scaleX_ - 0.5f);
        const float fy = std::max(0.0f, (static_cast<float>(y) + 0.5f) * scaleY_ - 0.5f);
        const std::uint32_t x0 = std::min(static_cast<std::uint32_t>(fx), image_.width - 1);
        const std::uint32_t y0 = std::min(static_cast<std::uint32_t>(fy), image_.height - 1);
        const std::uint32_t x1 = std::min(x0 + 1, image_.width - 1);
        const std::uint32_t y1 = std::min(y0 + 1, image_.height - 1);
        const float u = fx - static_cast<float>(x0);
        const float v = fy - static_cast<float>(y0);
        for (std::uint32_t c = 0; c < image_.channels; ++c) {
            const float top = std::lerp(image_.pixel(x0, y0)[c], image_.pixel(x1, y0)[c], u);
            const float bottom = std::lerp(image_.pixel(x0, y1)[c], image_.pixel(x1, y1)[c], u);
            value[c] = std::lerp(top, bottom, v);
        }
    }

  private:
    const image::Image& image_;
    float scaleX_, scaleY_;
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

void fillFromDraft(image::Image& picture, const image::Film& film, const image::Image& draft) {
    const Enlarged source(draft, picture.width, picture.height);
    constexpr std::uint32_t kTile = image::Film::kTile;
    for (std::uint32_t tile = 0; tile < film.tileCount(); ++tile) {
        if (film.samples(tile) > 0) continue;
        const std::uint32_t x0 = tile % film.tilesX() * kTile;
        const std::uint32_t y0 = tile / film.tilesX() * kTile;
        for (std::uint32_t y = y0; y < std::min(y0 + kTile, picture.height); ++y)
            for (std::uint32_t x = x0; x < std::min(x0 + kTile, picture.width); ++x)
                source.read(x, y, picture.pixel(x, y));
    }
}

} // namespace rt::app
