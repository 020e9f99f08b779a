#include "Common/Image/ImageRows.h"

#include <algorithm>
#include <utility>

#include "Common/Core/Parallel.h"

namespace rt::image {

ImageRows::ImageRows(const Image& image)
    : ImageRows(image.width, image.height, image.channels, [&image](std::uint32_t y, std::span<float> row) {
          std::copy_n(image.pixel(0, y), row.size(), row.begin());
      }) {}

void readInto(Image& image, const ImageRows& rows, std::size_t threads) {
    parallelFor(threads, rows.height, [&](std::size_t row) {
        const auto y = static_cast<std::uint32_t>(row);
        rows.read(y, {image.pixel(0, y), rows.rowValues()});
    });
}

Image toImage(const ImageRows& rows, std::size_t threads) {
    Image image(rows.width, rows.height, rows.channels);
    readInto(image, rows, threads);
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
