#include "Common/Image/ImageRows.h"

#include <algorithm>
#include <utility>

namespace rt::image {

ImageRows::ImageRows(const Image& image)
    : ImageRows(image.width, image.height, image.channels, [&image](std::uint32_t y, std::span<float> row) {
          std::copy_n(image.pixel(0, y), row.size(), row.begin());
      }) {}

Image toImage(const ImageRows& rows) {
    Image image(rows.width, rows.height, rows.channels);
    for (std::uint32_t y = 0; y < rows.height; ++y) rows.read(y, {image.pixel(0, y), rows.rowValues()});
    return image;
}

ImageRows mapped(ImageRows rows, std::function<float(float)> change) {
    ImageRows result = rows;
    result.read = [read = std::move(rows.read), change = std::move(change)](std::uint32_t y, std::span<float> row) {
        read(y, row);
        std::transform(row.begin(), row.end(), row.begin(), change);
    };
    return result;
}

} // namespace rt::image
