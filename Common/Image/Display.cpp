#include "Common/Image/Display.h"

#include <vector>

#include "Common/Shared/Tonemap.h"

namespace rt::image {

ImageRows toDisplay(const ImageRows& radiance, float exposure, std::uint32_t curve) {
    const auto readRow = [=, linear = std::vector<float>(radiance.rowValues())](std::uint32_t y,
                                                                                std::span<float> row) mutable {
        radiance.read(y, linear);
        for (std::size_t i = 0; i < row.size(); i += 3) {
            const float* from = &linear[i / 3 * radiance.channels];
            const std::size_t green = radiance.channels == 3 ? 1 : 0;
            const shared::vec3 shown = shared::tonemap({from[0], from[green], from[2 * green]}, exposure, curve);
            for (int c = 0; c < 3; ++c) row[i + static_cast<std::size_t>(c)] = shown[c];
        }
    };
    return {radiance.width, radiance.height, 3, readRow};
}

} // namespace rt::image
