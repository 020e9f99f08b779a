#include "Common/Image/Denoise/Planes.h"

#include "Common/Core/Parallel.h"

namespace rt::image {

Plane boxMean(const Plane& plane, int reach, std::size_t threads) {
    const std::size_t width = plane.width(), height = plane.height(), distance = static_cast<std::size_t>(reach);
    Plane means(width, height);
    parallelFor(threads, height, [&](std::size_t y) {
        std::vector<float> columns(width, 0.0f);
        const InReach rows(y, distance, height);
        const float rowShare = 1.0f / static_cast<float>(rows.count());
        for (std::size_t from = rows.first; from <= rows.last; ++from)
            for (std::size_t x = 0; x < width; ++x) columns[x] += plane.row(from)[x];
        for (std::size_t x = 0; x < width; ++x) {
            const InReach reach(x, distance, width);
            float sum = 0;
            for (std::size_t from = reach.first; from <= reach.last; ++from) sum += columns[from];
            means.row(y)[x] = sum * (1.0f / static_cast<float>(reach.count())) * rowShare;
        }
    });
    return means;
}

} // namespace rt::image
