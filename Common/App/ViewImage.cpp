#include "Common/App/ViewImage.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "Common/Image/Metrics.h"
#include "Common/Shared/Tonemap.h"

namespace rt::app {
namespace {

constexpr float kFloor = 0.1f; // of what an error is relative to: the square root of relMSE's

float meanOf(const float* rgb) {
    return (rgb[0] + rgb[1] + rgb[2]) / 3;
}

image::Image grey(const image::Image& depth) {
    float farthest = 0;
    for (const float d : depth.data) farthest = std::max(farthest, d);
    image::Image result(depth.width, depth.height, 3);
    for (std::size_t i = 0; i < depth.data.size(); ++i) {
        // Near is bright; where nothing was hit it is black.
        const float level = depth.data[i] > 0 ? 1 - 0.9f * depth.data[i] / farthest : 0;
        std::fill_n(&result.data[3 * i], 3, level * level);
    }
    return result;
}

} // namespace

AovRequest aovsFor(ViewMode mode) {
    AovRequest request;
    request.albedo = mode == ViewMode::Albedo;
    request.normal = mode == ViewMode::Normal;
    request.depth = mode == ViewMode::Depth;
    return request;
}

image::Image showFeatures(ViewMode mode, const AovImages& images) {
    if (mode == ViewMode::Depth) return grey(images.depth);
    if (mode == ViewMode::Albedo) return images.albedo;
    image::Image normals = images.normal;
    for (float& value : normals.data) value = shared::srgbDecode(std::clamp(0.5f * value + 0.5f, 0.0f, 1.0f));
    return normals;
}

image::Image showNoise(const image::Film& film, double scale) {
    const image::Image mean = film.resolve();
    const image::Image variance = film.varianceOfMean();
    std::vector<float> level(std::size_t{mean.width} * mean.height);
    for (std::size_t i = 0; i < level.size(); ++i) {
        const float error = std::sqrt(std::max(0.0f, meanOf(&variance.data[3 * i])));
        level[i] = static_cast<float>(scale) * error / (std::abs(meanOf(&mean.data[3 * i])) + kFloor);
    }
    return image::colourise(level, mean.width, mean.height);
}

image::Image showError(const image::Image& picture, const image::Image& reference, double scale) {
    std::vector<float> level(std::size_t{picture.width} * picture.height);
    for (std::size_t i = 0; i < level.size(); ++i) {
        float error = 0;
        for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) error += std::abs(picture.data[c] - reference.data[c]) / 3;
        level[i] = static_cast<float>(scale) * error / (std::abs(meanOf(&reference.data[3 * i])) + kFloor);
    }
    return image::colourise(level, picture.width, picture.height);
}

image::Image showCost(Cost cost, const image::Image& costs, double scale) {
    std::vector<float> sorted = costs.data;
    std::sort(sorted.begin(), sorted.end());
    // A pixel that costs as much as a typical one has the same colour in both units: about that of two rays.
    float most = sorted.empty() ? 0 : sorted.back(), unit = 1;
    if (cost == Cost::Time && !sorted.empty()) {
        most = sorted[(sorted.size() - 1) * 199 / 200];
        unit = std::max(0.5f * sorted[sorted.size() / 2], 1e-30f);
    }
    std::vector<float> level(costs.data.size());
    const float full = std::log1p(most / unit);
    for (std::size_t i = 0; i < level.size(); ++i)
        level[i] = full > 0 ? static_cast<float>(scale) * std::log1p(costs.data[i] / unit) / full : 0;
    return image::colourise(level, costs.width, costs.height);
}

} // namespace rt::app
