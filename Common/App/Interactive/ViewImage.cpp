#include "Common/App/Interactive/ViewImage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "Common/Image/Metrics.h"
#include "Common/Shared/Tonemap.h"

namespace rt::app {
namespace {

constexpr float kFloor = 0.1f; // of what an error is relative to: the square root of relMSE's

float meanOf(const float* rgb) {
    return (rgb[0] + rgb[1] + rgb[2]) / 3;
}

float percentile(std::vector<float> values, double share) {
    if (values.empty()) return 0;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

// To 1, 2 or 5 times a power of ten, so that pictures of one film have one scale for a while.
float roundedUp(float value) {
    if (!(value > 0)) return 1;
    const float power = std::pow(10.0f, std::floor(std::log10(value)));
    for (const float step : {1.0f, 2.0f, 5.0f})
        if (value <= step * power) return step * power;
    return 10 * power;
}

// Near is bright; where nothing was hit it is black.
image::Image greys(const std::vector<float>& level, std::uint32_t width, std::uint32_t height) {
    image::Image result(width, height, 3);
    for (std::size_t i = 0; i < level.size(); ++i) {
        const float root = level[i] > 0 ? 1 - 0.9f * std::min(level[i], 1.0f) : 0;
        std::fill_n(&result.data[3 * i], 3, root * root);
    }
    return result;
}

ViewImage show(const Legend& legend, const std::vector<float>& values, std::uint32_t width, std::uint32_t height) {
    ViewImage view{paint(legend, values, width, height), legend, image::Image(width, height, 1)};
    view.values.data = values;
    return view;
}

// The root of a squared error relative to the mean.
ViewImage showDeviation(Legend::Quantity quantity, const image::Image& mean, const image::Image& squared,
                        double scale) {
    std::vector<float> relative(std::size_t{mean.width} * mean.height);
    for (std::size_t i = 0; i < relative.size(); ++i) {
        const float error = std::sqrt(std::max(0.0f, meanOf(&squared.data[3 * i])));
        relative[i] = error / (std::abs(meanOf(&mean.data[3 * i])) + kFloor);
    }
    const float maximum = roundedUp(percentile(relative, 0.99)) / static_cast<float>(scale);
    return show({quantity, maximum}, relative, mean.width, mean.height);
}

} // namespace

AovRequest aovsFor(ViewMode mode) {
    AovRequest request;
    request.albedo = mode == ViewMode::Albedo;
    request.normal = mode == ViewMode::Normal;
    request.depth = mode == ViewMode::Depth;
    return request;
}

bool showsDenoiser(ViewMode mode) {
    return mode == ViewMode::HalfA || mode == ViewMode::HalfB || mode == ViewMode::DenoisedError ||
           mode == ViewMode::Bandwidth;
}

float Legend::level(float value) const {
    if (!(maximum > 0)) return 0;
    return unit > 0 ? std::log1p(value / unit) / std::log1p(maximum / unit) : value / maximum;
}
float Legend::value(float level) const {
    return unit > 0 ? unit * std::expm1(level * std::log1p(maximum / unit)) : level * maximum;
}

image::Image paint(const Legend& legend, const std::vector<float>& values, std::uint32_t width, std::uint32_t height) {
    std::vector<float> level(values.size());
    std::transform(values.begin(), values.end(), level.begin(), [&](float value) { return legend.level(value); });
    const bool isDistance = legend.quantity == Legend::Quantity::Distance;
    return isDistance ? greys(level, width, height) : image::colourise(level, width, height);
}

ViewImage showFeatures(ViewMode mode, const AovImages& images) {
    if (mode == ViewMode::Albedo) return {images.albedo, {}, images.albedo};
    if (mode == ViewMode::Depth) {
        const image::Image& depth = images.depth;
        Legend legend{Legend::Quantity::Distance};
        for (const float distance : depth.data) legend.maximum = std::max(legend.maximum, distance);
        return show(legend, depth.data, depth.width, depth.height);
    }
    image::Image normals = images.normal;
    for (float& value : normals.data) value = shared::srgbDecode(std::clamp(0.5f * value + 0.5f, 0.0f, 1.0f));
    return {std::move(normals), {}, images.normal};
}

ViewImage showNoise(const image::Film& film, double scale) {
    return showDeviation(Legend::Quantity::StandardError, film.resolve(), film.varianceOfMean(), scale);
}

ViewImage showDenoisedError(const image::Denoised& denoised, double scale) {
    return showDeviation(Legend::Quantity::DenoisedError, denoised.picture, denoised.error, scale);
}

ViewImage showBandwidth(const image::Denoised& denoised) {
    const image::Image& chosen = denoised.bandwidth;
    return show({Legend::Quantity::Bandwidth, static_cast<float>(image::kDenoiseCandidates - 1)}, chosen.data,
                chosen.width, chosen.height);
}

ViewImage showError(const image::Image& picture, const image::Image& reference, double scale) {
    std::vector<float> relative(std::size_t{picture.width} * picture.height);
    for (std::size_t i = 0; i < relative.size(); ++i) {
        float error = 0;
        for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) error += std::abs(picture.data[c] - reference.data[c]) / 3;
        relative[i] = error / (std::abs(meanOf(&reference.data[3 * i])) + kFloor);
    }
    return show({Legend::Quantity::Error, static_cast<float>(1 / scale)}, relative, picture.width, picture.height);
}

ViewImage showCost(Cost cost, const image::Image& costs, double scale) {
    if (costs.data.empty()) return {};
    std::vector<float> sorted = costs.data;
    std::sort(sorted.begin(), sorted.end());
    // A pixel that costs as much as a typical one has the same colour in both units: about that of two rays.
    Legend legend{Legend::Quantity::Rays, sorted.back(), 1};
    if (cost == Cost::Time) {
        legend = {Legend::Quantity::Time, sorted[(sorted.size() - 1) * 199 / 200],
                  std::max(0.5f * sorted[sorted.size() / 2], 1e-30f)};
    }
    legend.maximum /= static_cast<float>(scale);
    return show(legend, costs.data, costs.width, costs.height);
}

} // namespace rt::app
