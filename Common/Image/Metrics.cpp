#include "Common/Image/Metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "Common/Core/Error.h"
#include "Common/Shared/Tonemap.h"

namespace rt::image {

namespace {

std::string sizeOf(const Image& image) {
    return std::to_string(image.width) + "x" + std::to_string(image.height) + " pixels with " +
           std::to_string(image.channels) + " channel(s)";
}

void checkComparable(const Image& image, const Image& reference) {
    if (image.width != reference.width || image.height != reference.height || image.channels != reference.channels)
        throw InputError("images differ in size: " + sizeOf(image) + " against " + sizeOf(reference));
    checkFinite(image, "the image");
    checkFinite(reference, "the reference");
}

double square(double x) {
    return x * x;
}

double displayed(float linear) {
    return shared::srgbEncode(std::clamp(linear, 0.0f, 1.0f));
}

} // namespace

// Dark blue to yellow at even steps of lightness; in between linear in sRGB.
Image colourise(const std::vector<float>& level, std::uint32_t width, std::uint32_t height) {
    constexpr float kRamp[][3] = {{0.02f, 0.02f, 0.10f}, {0.10f, 0.12f, 0.42f}, {0.08f, 0.31f, 0.52f},
                                  {0.06f, 0.49f, 0.50f}, {0.25f, 0.67f, 0.38f}, {0.62f, 0.82f, 0.24f},
                                  {1.00f, 0.94f, 0.40f}};
    constexpr std::size_t kSteps = std::size(kRamp) - 1;
    Image image(width, height, 3);
    for (std::size_t i = 0; i < level.size(); ++i) {
        const float position = std::clamp(level[i], 0.0f, 1.0f) * kSteps;
        const auto step = std::min(static_cast<std::size_t>(position), kSteps - 1);
        const float part = position - static_cast<float>(step);
        for (std::size_t c = 0; c < 3; ++c)
            image.data[i * 3 + c] = shared::srgbDecode(std::lerp(kRamp[step][c], kRamp[step + 1][c], part));
    }
    return image;
}

void checkFinite(const Image& image, const std::string& name) {
    const auto isBad = [](float value) { return !std::isfinite(value); };
    const auto bad = std::find_if(image.data.begin(), image.data.end(), isBad);
    if (bad == image.data.end()) return;
    const auto pixel = static_cast<std::size_t>(bad - image.data.begin()) / image.channels;
    throw InputError(name + ": a value of pixel (" + std::to_string(pixel % image.width) + ", " +
                     std::to_string(pixel / image.width) + ") is not finite");
}

ErrorFigures compare(const Image& image, const Image& reference) {
    checkComparable(image, reference);
    ErrorFigures sums;
    double displayedSquares = 0;
    for (std::size_t i = 0; i < image.data.size(); ++i) {
        const double target = reference.data[i];
        const double difference = image.data[i] - target;
        sums.mse += square(difference);
        sums.relmse += square(difference) / (square(target) + kRelativeFloor);
        sums.mae += std::abs(difference);
        sums.maxAbs = std::max(sums.maxAbs, std::abs(difference));
        displayedSquares += square(displayed(image.data[i]) - displayed(reference.data[i]));
    }
    const auto count = static_cast<double>(image.data.size());
    const double mse = sums.mse / count;
    const double displayedMse = displayedSquares / count;
    const double psnr = displayedMse > 0 ? -10 * std::log10(displayedMse) : std::numeric_limits<double>::infinity();
    return {mse, std::sqrt(mse), sums.relmse / count, sums.mae / count, psnr, sums.maxAbs};
}

Image heatMap(const Image& image, const Image& reference) {
    checkComparable(image, reference);
    std::vector<float> error(std::size_t{image.width} * image.height);
    for (std::size_t i = 0; i < image.data.size(); ++i)
        error[i / image.channels] += std::abs(image.data[i] - reference.data[i]) / static_cast<float>(image.channels);
    std::vector<float> sorted = error;
    const auto brightest = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() - 1 - sorted.size() / 200);
    std::nth_element(sorted.begin(), brightest, sorted.end());
    if (const float scale = *brightest; scale > 0)
        for (float& value : error) value /= scale;
    return colourise(error, image.width, image.height);
}

double referenceRelMse(const Image& reference, const Image& variance) {
    double sum = 0;
    for (std::size_t i = 0; i < reference.data.size(); ++i)
        sum += variance.data[i] / (square(reference.data[i]) + kRelativeFloor);
    return sum / static_cast<double>(reference.data.size());
}

std::array<double, 3> channelMeans(const ImageRows& image) {
    std::array<double, 3> means = {};
    std::vector<float> row(image.rowValues());
    for (std::uint32_t y = 0; y < image.height; ++y) {
        image.read(y, row);
        for (std::size_t i = 0; i < row.size(); i += image.channels)
            for (std::size_t c = 0; c < 3; ++c) means[c] += row[i + (image.channels == 3 ? c : 0)];
    }
    for (double& mean : means) mean /= static_cast<double>(image.width) * image.height;
    return means;
}

std::array<double, 3> standardErrors(const ImageRows& variance) {
    std::array<double, 3> errors = channelMeans(variance);
    for (double& error : errors) error = std::sqrt(error / (static_cast<double>(variance.width) * variance.height));
    return errors;
}

} // namespace rt::image
