#include "Common/Image/Display.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
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

float autoExposure(const Image& radiance) {
    constexpr std::size_t kMaxPixels = 1 << 16; // that are looked at
    constexpr double kMiddleGrey = 0.18, kDarkest = 0.1, kBrightest = 0.05, kMaxStops = 20;
    const std::size_t pixels = std::size_t{radiance.width} * radiance.height;
    const std::size_t step = std::max<std::size_t>(1, pixels / kMaxPixels);
    std::vector<float> stops;
    for (std::size_t i = 0; i < pixels; i += step) {
        const float* rgb = &radiance.data[i * radiance.channels];
        const float luminance = radiance.channels == 3 ? shared::displayLuminance({rgb[0], rgb[1], rgb[2]}) : rgb[0];
        if (luminance > 0 && std::isfinite(luminance)) stops.push_back(std::log2(luminance));
    }
    if (stops.empty()) return 0;
    std::sort(stops.begin(), stops.end());
    const auto count = static_cast<double>(stops.size());
    const auto from = static_cast<std::ptrdiff_t>(kDarkest * count);
    const auto to = std::max(from + 1, static_cast<std::ptrdiff_t>((1 - kBrightest) * count));
    const double mean = std::accumulate(stops.begin() + from, stops.begin() + to, 0.0) / static_cast<double>(to - from);
    return static_cast<float>(std::clamp(std::log2(kMiddleGrey) - mean, -kMaxStops, kMaxStops));
}

} // namespace rt::image
