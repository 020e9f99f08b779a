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

// The other half's pilot in a row of pixels, interleaved RGB.
struct PilotRow {
    std::vector<float> means;
    std::vector<float> variances; // of a sample
};

PilotRow readPilot(const Film& film, std::uint32_t half, std::uint32_t y) {
    const std::uint32_t width = film.desc().width;
    PilotRow row{std::vector<float>(std::size_t{width} * 3), std::vector<float>(std::size_t{width} * 3)};
    for (std::uint32_t x = 0; x < width; ++x) {
        const std::uint32_t tile = y / kTile * film.tilesX() + x / kTile;
        const std::size_t value = (std::size_t{y % kTile} * kTile + x % kTile) * 3;
        double samples = 0, sums[3] = {}, squares[3] = {};
        for (std::uint32_t r = half; r < film.desc().replicates; r += 2) {
            const Film::TileState state = film.state(tile, r);
            samples += state.samples;
            for (std::size_t c = 0; c < 3; ++c) {
                sums[c] += state.sums[value + c] + (state.open.empty() ? 0.0 : double{state.open[value + c]});
                squares[c] += state.squares[value + c];
            }
        }
        for (std::size_t c = 0; c < 3; ++c) {
            const double spread = squares[c] - sums[c] * sums[c] / samples;
            const auto variance = static_cast<float>(std::max(spread, 0.0) / (samples - 1));
            row.variances[3 * x + c] = variance < kLargest ? variance : kLargest;
            row.means[3 * x + c] = static_cast<float>(sums[c] / samples);
        }
    }
    return row;
}

// What a sample of each pixel, row by row, adds to the errors of the image.
struct Noise {
    std::vector<float> absolute; // to MSE
    std::vector<float> relative; // to relMSE
};

// Of the pixels of a row, between its neighbours: empty ones beyond the image.
void appendNoise(const PilotRow* const (&rows)[3], Noise& noise) {
    constexpr double kWeights[3] = {1, 2, 1};
    const std::size_t width = rows[1]->means.size() / 3;
    for (std::size_t x = 0; x < width; ++x) {
        double weights = 0, means[3] = {}, variances[3] = {};
        for (std::size_t j = 0; j < 3; ++j) {
            if (rows[j]->means.empty()) continue;
            for (std::size_t i = x == 0 ? 1 : 0; i < 3 && x + i <= width; ++i) {
                const double weight = kWeights[j] * kWeights[i];
                weights += weight;
                for (std::size_t c = 0; c < 3; ++c) {
                    means[c] += weight * rows[j]->means[3 * (x + i - 1) + c];
                    variances[c] += weight * rows[j]->variances[3 * (x + i - 1) + c];
                }
            }
        }
        double absolute = 0, relative = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const double mean = means[c] / weights, variance = variances[c] / weights;
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
        appendNoise({&above, &here, &below}, noise);
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
