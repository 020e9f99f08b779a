#include "Common/Image/ErrorAnalysis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "Common/Image/Flip.h"
#include "Common/Image/Metrics.h"
#include "Common/Image/Statistics.h"

namespace rt::image {
namespace {

constexpr double kFirefly = 10; // times the rmse
constexpr std::uint32_t kTile = 8;

double meanOf(const Image& image) {
    double sum = 0;
    for (const float value : image.data) sum += value;
    return sum / static_cast<double>(image.data.size());
}

double worstBiasZ(const Image& image, const Image& reference) {
    std::array<double, 4> sums{}, squares{};
    for (std::size_t i = 0; i < image.data.size(); ++i) {
        const double difference = static_cast<double>(image.data[i]) - reference.data[i];
        sums[i % image.channels] += difference;
        squares[i % image.channels] += difference * difference;
    }
    double worst = 0;
    for (std::size_t c = 0; c < sums.size(); ++c) {
        const double z = squares[c] > 0 ? sums[c] / std::sqrt(squares[c]) : 0.0;
        if (std::abs(z) > std::abs(worst)) worst = z;
    }
    return worst;
}

double tileError(const Image& image, const Image& reference) {
    const std::uint32_t tilesX = (image.width + kTile - 1) / kTile, tilesY = (image.height + kTile - 1) / kTile;
    std::vector<double> sums(std::size_t{tilesX} * tilesY), counts(sums.size());
    for (std::size_t i = 0; i < image.data.size(); ++i) {
        const std::size_t pixel = i / image.channels;
        const std::size_t tile = pixel / image.width / kTile * tilesX + pixel % image.width / kTile;
        const double difference = static_cast<double>(image.data[i]) - reference.data[i];
        sums[tile] += difference * difference;
        counts[tile] += 1;
    }
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= counts[i];
    return std::sqrt(estimate(sums).varianceOfMean);
}

void findFireflies(const Image& image, const Image& reference, double rmse, ErrorAnalysis& result) {
    double all = 0, theirs = 0;
    for (std::size_t pixel = 0; pixel < image.data.size(); pixel += image.channels) {
        double squares = 0, highest = 0;
        for (std::size_t c = 0; c < image.channels; ++c) {
            const double difference = static_cast<double>(image.data[pixel + c]) - reference.data[pixel + c];
            squares += difference * difference;
            highest = std::max(highest, difference);
        }
        all += squares;
        if (!(highest > kFirefly * rmse)) continue;
        theirs += squares;
        ++result.fireflies;
    }
    result.fireflyShare = all > 0 ? theirs / all : 0;
}

} // namespace

ErrorAnalysis analyseError(const Image& image, const Reference& reference) {
    const ErrorFigures figures = compare(image, reference.mean);
    ErrorAnalysis result;
    result.referenceMse = meanOf(reference.variance);
    result.referenceRelmse = estimatedRelMse(reference.mean, reference.variance);
    result.mse = figures.mse - result.referenceMse;
    result.rmse = std::sqrt(std::max(result.mse, 0.0));
    result.relmse = figures.relmse - result.referenceRelmse;
    result.mae = figures.mae;
    result.psnr = figures.psnr;
    result.flip = flip(image, reference.mean);
    result.mseError = tileError(image, reference.mean);
    result.biasZ = worstBiasZ(image, reference.mean);
    findFireflies(image, reference.mean, figures.rmse, result);
    return result;
}

} // namespace rt::image
