#include "Common/Image/ErrorAnalysis.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "Common/Image/Flip.h"
#include "Common/Image/Metrics.h"

namespace rt::image {
namespace {

constexpr double kFirefly = 10; // times the rmse
constexpr std::uint32_t kCell = 8;

// Of squares of pixels, which are independent of each other.
double worstBiasZ(const Image& image, const Image& reference, std::uint32_t side) {
    const std::uint32_t columns = (image.width + side - 1) / side;
    std::vector<double> row(columns); // sums of differences
    double worst = 0;
    for (std::uint32_t c = 0; c < image.channels; ++c) {
        double sum = 0, squares = 0;
        for (std::uint32_t top = 0; top < image.height; top += side) {
            std::fill(row.begin(), row.end(), 0.0);
            for (std::uint32_t y = top; y < std::min(top + side, image.height); ++y)
                for (std::uint32_t x = 0; x < image.width; ++x)
                    row[x / side] += static_cast<double>(image.pixel(x, y)[c]) - reference.pixel(x, y)[c];
            for (const double difference : row) {
                sum += difference;
                squares += difference * difference;
            }
        }
        const double z = squares > 0 ? sum / std::sqrt(squares) : 0.0;
        if (std::abs(z) > std::abs(worst)) worst = z;
    }
    return worst;
}

template <class Predicate> // (const float* reference) -> bool: whether a pixel counts
MeanSquares meanSquares(const Image& image, const Reference& reference, Predicate counts) {
    struct Tile {
        double squares = 0, values = 0;
    };
    const std::uint32_t tilesX = (image.width + kCell - 1) / kCell, tilesY = (image.height + kCell - 1) / kCell;
    std::vector<Tile> tiles(std::size_t{tilesX} * tilesY);
    double squares = 0, values = 0, variance = 0;
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const float* const target = reference.mean.pixel(x, y);
            if (!counts(target)) continue;
            Tile& tile = tiles[std::size_t{y / kCell} * tilesX + x / kCell];
            for (std::uint32_t c = 0; c < image.channels; ++c) {
                const double difference = static_cast<double>(image.pixel(x, y)[c]) - target[c];
                tile.squares += difference * difference;
                variance += reference.variance.pixel(x, y)[c];
            }
            tile.values += image.channels;
        }
    for (const Tile& tile : tiles) {
        squares += tile.squares;
        values += tile.values;
    }
    if (values == 0) return {};
    // The error of a ratio of sums: tiles with more values have more weight.
    const double mean = squares / values, count = static_cast<double>(tiles.size());
    double spread = 0;
    for (const Tile& tile : tiles) {
        const double excess = tile.squares - mean * tile.values;
        spread += excess * excess;
    }
    MeanSquares result;
    result.share = values / static_cast<double>(image.data.size());
    result.referenceMse = variance / values;
    result.mse = mean - result.referenceMse;
    result.mseError = tiles.size() > 1 ? std::sqrt(spread * count / (count - 1)) / values : 0;
    return result;
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

MeanSquares meanSquaresUpTo1(const Image& image, const Reference& reference) {
    return meanSquares(image, reference, [channels = image.channels](const float* pixel) {
        return std::all_of(pixel, pixel + channels, [](float value) { return value <= 1; });
    });
}

ErrorAnalysis analyseError(const Image& image, const Reference& reference, std::uint32_t dependentSide) {
    const ErrorFigures figures = compare(image, reference.mean);
    ErrorAnalysis result;
    const MeanSquares all = meanSquares(image, reference, [](const float*) { return true; });
    result.mse = all.mse;
    result.referenceMse = all.referenceMse;
    result.mseError = all.mseError;
    result.upTo1 = meanSquaresUpTo1(image, reference);
    result.referenceRelmse = referenceRelMse(reference.mean, reference.variance);
    result.rmse = std::sqrt(std::max(result.mse, 0.0));
    result.relmse = figures.relmse - result.referenceRelmse;
    result.mae = figures.mae;
    result.psnr = figures.psnr;
    result.flip = flip(image, reference.mean);
    result.biasZ = worstBiasZ(image, reference.mean, dependentSide);
    findFireflies(image, reference.mean, figures.rmse, result);
    return result;
}

} // namespace rt::image
