#include "Common/Image/SamplePlan.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "Common/Image/Metrics.h"

namespace rt::image {
namespace {

// Tried at 16 to 1024 samples per pixel on nine scenes; none of them has a sharp optimum.
constexpr std::uint32_t kLeastPilot = 4; // samples of a half
constexpr double kRelative = 0.7;        // share of relMSE in the blend
constexpr double kAdded = 0.5;           // to every pixel, of the mean
constexpr double kMost = 16;             // for a pixel, of the mean

constexpr std::uint32_t kTile = Film::kTile;
constexpr float kLargest = 1e30f; // in place of a variance that is no number, so that sums of it are

// A half's pilot in a row of pixels, interleaved RGB; empty beyond the image.
struct PilotRow {
    std::vector<float> means;
    std::vector<float> variances; // of a sample
};

PilotRow readPilot(const Film& film, std::uint32_t half, std::uint32_t y) {
    const std::size_t width = film.desc().width;
    PilotRow row{std::vector<float>(width * 3), std::vector<float>(width * 3)};
    const std::size_t first = std::size_t{y % kTile} * kTile * 3; // value of the tile
    for (std::uint32_t tileX = 0; tileX < film.tilesX(); ++tileX) {
        double samples = 0, sums[kTile * 3] = {}, squares[kTile * 3] = {};
        for (std::uint32_t r = half; r < film.desc().replicates; r += 2) {
            const Film::TileState state = film.state(y / kTile * film.tilesX() + tileX, r);
            samples += state.samples;
            for (std::size_t i = 0; i < kTile * 3; ++i) {
                sums[i] += state.sums[first + i] + (state.open.empty() ? 0.0 : double{state.open[first + i]});
                squares[i] += state.squares[first + i];
            }
        }
        const std::size_t begin = std::size_t{tileX} * kTile * 3;
        for (std::size_t i = 0; i < std::min<std::size_t>(kTile * 3, row.means.size() - begin); ++i) {
            const double spread = squares[i] - sums[i] * sums[i] / samples;
            const auto variance = static_cast<float>(std::max(spread, 0.0) / (samples - 1));
            row.variances[begin + i] = variance < kLargest ? variance : kLargest;
            row.means[begin + i] = static_cast<float>(sums[i] / samples);
        }
    }
    return row;
}

// What a sample of each pixel, row by row, adds to the errors of the image.
struct Noise {
    std::vector<float> absolute; // to MSE
    std::vector<float> relative; // to relMSE
};

// Sums over three rows by the weights 1 2 1, between a pixel of zeros at either end.
std::vector<double> sumOfRows(const std::vector<float>& above, const std::vector<float>& here,
                              const std::vector<float>& below) {
    std::vector<double> sums(here.size() + 6);
    for (std::size_t i = 0; i < here.size(); ++i) sums[3 + i] = 2 * double{here[i]};
    for (const std::vector<float>* row : {&above, &below})
        for (std::size_t i = 0; i < row->size(); ++i) sums[3 + i] += double{(*row)[i]};
    return sums;
}

// Of the pixels of a row, between its neighbours.
void appendNoise(const PilotRow& above, const PilotRow& here, const PilotRow& below, Noise& noise) {
    const std::vector<double> means = sumOfRows(above.means, here.means, below.means);
    const std::vector<double> variances = sumOfRows(above.variances, here.variances, below.variances);
    const std::size_t width = here.means.size() / 3;
    const double rows = 2.0 + (above.means.empty() ? 0 : 1) + (below.means.empty() ? 0 : 1);
    for (std::size_t x = 0; x < width; ++x) {
        const double scale = 1 / (rows * (2.0 + (x > 0 ? 1 : 0) + (x + 1 < width ? 1 : 0)));
        double absolute = 0, relative = 0;
        for (std::size_t i = 3 * x; i < 3 * x + 3; ++i) { // of the pixel to the left
            const double mean = scale * (means[i] + 2 * means[i + 3] + means[i + 6]);
            const double variance = scale * (variances[i] + 2 * variances[i + 3] + variances[i + 6]);
            absolute += variance;
            relative += variance / (mean * mean + kRelativeFloor);
        }
        noise.absolute.push_back(static_cast<float>(absolute));
        noise.relative.push_back(static_cast<float>(relative));
    }
}

Noise noiseOf(const Film& film, std::uint32_t half) {
    const std::uint32_t height = film.desc().height;
    Noise noise;
    noise.absolute.reserve(std::size_t{film.desc().width} * height);
    noise.relative.reserve(noise.absolute.capacity());
    PilotRow above, here = readPilot(film, half, 0), below;
    for (std::uint32_t y = 0; y < height; ++y) {
        below = y + 1 < height ? readPilot(film, half, y + 1) : PilotRow{};
        appendNoise(above, here, below, noise);
        above = std::move(here);
        here = std::move(below);
    }
    return noise;
}

// To which the samples of each pixel should be proportional.
std::vector<float> importanceOf(const Noise& noise) {
    const double absolute = std::accumulate(noise.absolute.begin(), noise.absolute.end(), 0.0);
    const double relative = std::accumulate(noise.relative.begin(), noise.relative.end(), 0.0);
    const std::size_t pixels = noise.absolute.size();
    if (!(absolute > 0)) return std::vector<float>(pixels, 1.0f); // nothing was seen to differ
    std::vector<float> importance(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        const double share = (1 - kRelative) * noise.absolute[i] / absolute + kRelative * noise.relative[i] / relative;
        importance[i] = static_cast<float>(std::sqrt(share));
    }
    const double mean = std::accumulate(importance.begin(), importance.end(), 0.0) / static_cast<double>(pixels);
    for (float& value : importance) value = static_cast<float>(std::min(value + kAdded * mean, kMost * mean));
    return importance;
}

// The factor at which max(least, factor * importance) sums up to `total`. The sum is a convex function of it, so that
// Newton's method comes down to it from where no pixel is at the least.
double factorFor(const std::vector<float>& importance, double least, double total) {
    double factor = total / std::accumulate(importance.begin(), importance.end(), 0.0);
    for (;;) {
        double sum = 0, slope = 0;
        for (const float value : importance) {
            const double samples = factor * value;
            sum += std::max(samples, least);
            if (samples > least) slope += value;
        }
        const double next = slope > 0 ? factor - (sum - total) / slope : factor;
        if (!(next < factor * (1 - 1e-9))) return factor;
        factor = next;
    }
}

// Samples of each pixel, at least `least`, `total` in all. What rounding takes from a pixel its successor gets.
std::vector<std::uint32_t> allocate(const std::vector<float>& importance, std::uint32_t least, std::uint64_t total) {
    const double factor = factorFor(importance, least, static_cast<double>(total));
    const std::uint64_t spare = total - least * std::uint64_t{importance.size()};
    std::vector<std::uint32_t> counts(importance.size());
    double wanted = 0; // beyond the least, by the pixels so far
    std::uint64_t given = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        wanted += std::max(factor * importance[i] - least, 0.0);
        const bool isLast = i + 1 == counts.size();
        const std::uint64_t due = isLast ? spare : std::min(static_cast<std::uint64_t>(wanted + 0.5), spare);
        counts[i] = least + static_cast<std::uint32_t>(due - given);
        given = due;
    }
    return counts;
}

} // namespace

std::uint32_t pilotSamples(std::uint32_t spp) {
    const std::uint32_t pilot = std::bit_floor(spp / 4);
    const bool fits = spp <= Film::kMaxSamples / kMost; // whatever a pixel gets
    return pilot < kLeastPilot || !fits ? 0 : 2 * pilot;
}

std::vector<std::uint32_t> makeSamplePlan(const Film& film, std::uint32_t spp) {
    const std::uint32_t width = film.desc().width, height = film.desc().height, replicates = film.desc().replicates;
    const std::uint64_t pixels = std::uint64_t{width} * height;
    const std::uint32_t shares = replicates / 2; // of a half
    std::vector<std::uint32_t> plan(std::size_t{film.tileCount()} * replicates * Film::kTilePixels);
    for (std::uint32_t half = 0; half < 2; ++half) {
        const std::uint64_t samples = (spp + 1 - half) / 2; // sample s of a pixel is one of half s mod 2
        const auto counts = allocate(importanceOf(noiseOf(film, 1 - half)), pilotSamples(spp) / 2, samples * pixels);
        for (std::size_t i = 0; i < counts.size(); ++i) {
            const auto x = static_cast<std::uint32_t>(i % width), y = static_cast<std::uint32_t>(i / width);
            const std::size_t tile = std::size_t{y / kTile} * film.tilesX() + x / kTile;
            const std::size_t pixel = std::size_t{y % kTile} * kTile + x % kTile;
            for (std::uint32_t share = 0; share < shares; ++share) {
                const std::size_t slot = tile * replicates + 2 * share + half;
                plan[slot * Film::kTilePixels + pixel] = (counts[i] + shares - 1 - share) / shares;
            }
        }
    }
    return plan;
}

std::uint64_t goalOf(const Film& film, std::uint32_t spp) {
    if (film.hasPlan()) return std::uint64_t{film.planEnd()} * film.desc().replicates;
    return film.isPilot() ? pilotSamples(spp) : spp;
}

} // namespace rt::image
