#include "Common/Image/SamplePlan.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "Common/Core/Parallel.h"
#include "Common/Image/Metrics.h"

namespace rt::image {
namespace {

// Tried at 16 to 1024 samples per pixel on nine scenes; none of them has a sharp optimum.
constexpr std::uint32_t kMinPilot = 4; // samples of a half
constexpr double kRelative = 0.7;      // share of relMSE in the blend
constexpr double kAdded = 0.5;         // to every pixel, of the mean
constexpr double kMax = 16;            // for a pixel, of the mean

constexpr std::uint32_t kTile = Film::kTile;
constexpr float kLargest = 1e30f; // in place of a variance that is no number, so that sums of it are

struct Cancelled {};

struct Sums {
    double first = 0;
    double second = 0;
};

// Work on the pixels of an image, some rows at a time. What comes of it does not depend on the number of threads.
class RowLoop {
  public:
    RowLoop(const FilmDesc& desc, const PlanWork& work)
        : width_(desc.width), chunks_(desc.height, kRows), work_(work) {}

    // Calls f(number of the chunk, first row, row behind the last). Throws Cancelled.
    template <class Function>
    void forEachChunk(const Function& f) const {
        parallelFor(work_.threads, chunks_.count, [&](std::size_t chunk) {
            if (work_.cancel != nullptr && work_.cancel->load(std::memory_order_relaxed)) throw Cancelled{};
            f(chunk, chunks_.begin(chunk), chunks_.end(chunk));
        });
    }
    // Adds up, in order, what f(first pixel, pixel behind the last) returns of each chunk.
    template <class Function>
    Sums sum(const Function& f) const {
        Sums total;
        for (const Sums& part : sumsOfChunks(f)) {
            total.first += part.first;
            total.second += part.second;
        }
        return total;
    }
    template <class Function>
    std::vector<Sums> sumsOfChunks(const Function& f) const {
        std::vector<Sums> parts(chunks_.count);
        forEachChunk([&](std::size_t chunk, std::size_t first, std::size_t end) {
            parts[chunk] = f(first * width_, end * width_);
        });
        return parts;
    }
    std::size_t width() const { return width_; }

  private:
    static constexpr std::size_t kRows = 2 * Film::kTile; // whole squares of pixels that depend on each other

    std::size_t width_;
    Chunks chunks_;
    PlanWork work_;
};

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
    Sums total;                  // of either
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

// Of the pixels of a row, between its neighbours; the first of them is pixel `at` of the image. Returns their sums.
Sums findNoise(const PilotRow& above, const PilotRow& here, const PilotRow& below, std::size_t at, Noise& noise) {
    const std::vector<double> means = sumOfRows(above.means, here.means, below.means);
    const std::vector<double> variances = sumOfRows(above.variances, here.variances, below.variances);
    const std::size_t width = here.means.size() / 3;
    const double rows = 2.0 + (above.means.empty() ? 0 : 1) + (below.means.empty() ? 0 : 1);
    Sums sums;
    for (std::size_t x = 0; x < width; ++x) {
        const double scale = 1 / (rows * (2.0 + (x > 0 ? 1 : 0) + (x + 1 < width ? 1 : 0)));
        double absolute = 0, relative = 0;
        for (std::size_t i = 3 * x; i < 3 * x + 3; ++i) { // of the pixel to the left
            const double mean = scale * (means[i] + 2 * means[i + 3] + means[i + 6]);
            const double variance = scale * (variances[i] + 2 * variances[i + 3] + variances[i + 6]);
            absolute += variance;
            relative += variance / (mean * mean + kRelativeFloor);
        }
        noise.absolute[at + x] = static_cast<float>(absolute);
        noise.relative[at + x] = static_cast<float>(relative);
        sums.first += absolute;
        sums.second += relative;
    }
    return sums;
}

Noise noiseOf(const Film& film, std::uint32_t half, const RowLoop& loop) {
    const std::uint32_t width = film.desc().width, height = film.desc().height;
    Noise noise;
    noise.absolute.resize(std::size_t{width} * height);
    noise.relative.resize(noise.absolute.size());
    noise.total = loop.sum([&](std::size_t firstPixel, std::size_t endPixel) {
        const auto first = static_cast<std::uint32_t>(firstPixel / width);
        const auto end = static_cast<std::uint32_t>(endPixel / width);
        PilotRow above = first > 0 ? readPilot(film, half, first - 1) : PilotRow{};
        PilotRow here = readPilot(film, half, first);
        Sums sums;
        for (std::uint32_t y = first; y < end; ++y) {
            PilotRow below = y + 1 < height ? readPilot(film, half, y + 1) : PilotRow{};
            const Sums row = findNoise(above, here, below, std::size_t{y} * width, noise);
            sums.first += row.first;
            sums.second += row.second;
            above = std::move(here);
            here = std::move(below);
        }
        return sums;
    });
    return noise;
}

// Gives each pixel of a square the mean of them.
void averageSquares(std::vector<float>& values, std::size_t side, const RowLoop& loop) {
    const std::size_t width = loop.width();
    loop.forEachChunk([&](std::size_t, std::size_t firstRow, std::size_t endRow) {
        for (std::size_t y = firstRow; y < endRow; y += side)
            for (std::size_t x = 0; x < width; x += side) {
                const std::size_t bottom = std::min(y + side, endRow), right = std::min(x + side, width);
                const auto eachPixel = [&](const auto& f) {
                    for (std::size_t row = y; row < bottom; ++row)
                        for (std::size_t column = x; column < right; ++column) f(values[row * width + column]);
                };
                double sum = 0;
                eachPixel([&](float value) { sum += double{value}; });
                const auto mean = static_cast<float>(sum / static_cast<double>((bottom - y) * (right - x)));
                eachPixel([&](float& value) { value = mean; });
            }
    });
}

// To which the samples of each pixel should be proportional.
std::vector<float> importanceOf(const Noise& noise, std::uint32_t dependentSide, const RowLoop& loop) {
    const auto [absolute, relative] = noise.total;
    const std::size_t pixels = noise.absolute.size();
    if (!(absolute > 0)) return std::vector<float>(pixels, 1.0f); // nothing was seen to differ
    const double toMse = (1 - kRelative) / absolute, toRelMse = kRelative / relative;
    std::vector<float> importance(pixels); // at first its square
    loop.forEachChunk([&](std::size_t, std::size_t firstRow, std::size_t endRow) {
        for (std::size_t i = firstRow * loop.width(); i < endRow * loop.width(); ++i) {
            const double share = toMse * double{noise.absolute[i]} + toRelMse * double{noise.relative[i]};
            importance[i] = static_cast<float>(share);
        }
    });
    if (dependentSide > 1) averageSquares(importance, dependentSide, loop);
    const Sums sums = loop.sum([&](std::size_t first, std::size_t end) {
        Sums part;
        for (std::size_t i = first; i < end; ++i) {
            importance[i] = std::sqrt(importance[i]);
            part.first += double{importance[i]};
        }
        return part;
    });
    const double mean = sums.first / static_cast<double>(pixels);
    for (float& value : importance) value = static_cast<float>(std::min(double{value} + kAdded * mean, kMax * mean));
    return importance;
}

// The factor at which max(least, factor * importance) sums up to `total`. The sum is a convex function of it, so that
// Newton's method comes down to it from where no pixel is at the least.
double factorFor(const std::vector<float>& importance, double minimum, double total, const RowLoop& loop) {
    const auto sumsAt = [&](double factor, double minimum) { // of the samples, and their slope
        return loop.sum([&](std::size_t first, std::size_t end) {
            Sums part;
            for (std::size_t i = first; i < end; ++i) {
                const double samples = factor * double{importance[i]};
                part.first += std::max(samples, minimum);
                part.second += samples > minimum ? double{importance[i]} : 0.0;
            }
            return part;
        });
    };
    double factor = total / sumsAt(1, 0).first;
    for (;;) {
        const Sums at = sumsAt(factor, minimum);
        const double next = at.second > 0 ? factor - (at.first - total) / at.second : factor;
        if (!(next < factor * (1 - 1e-9))) return factor;
        factor = next;
    }
}

// Samples of each pixel, at least `least`, `total` in all. What rounding takes from a pixel its successor gets.
std::vector<std::uint32_t> allocate(const std::vector<float>& importance, std::uint32_t minimum, std::uint64_t total,
                                    const RowLoop& loop) {
    const double factor = factorFor(importance, minimum, static_cast<double>(total), loop);
    const std::uint64_t spare = total - minimum * std::uint64_t{importance.size()};
    const auto wantedBy = [&](std::size_t pixel) { // beyond the least
        return std::max(factor * double{importance[pixel]} - minimum, 0.0);
    };
    const auto due = [spare](double wanted) { return std::min(static_cast<std::uint64_t>(wanted + 0.5), spare); };
    const std::vector<Sums> chunks = loop.sumsOfChunks([&](std::size_t first, std::size_t end) {
        Sums part;
        for (std::size_t i = first; i < end; ++i) part.first += wantedBy(i);
        return part;
    });
    std::vector<double> before(chunks.size() + 1); // what the pixels before each chunk want
    for (std::size_t i = 0; i < chunks.size(); ++i) before[i + 1] = before[i] + chunks[i].first;
    std::vector<std::uint32_t> counts(importance.size());
    loop.forEachChunk([&](std::size_t chunk, std::size_t firstRow, std::size_t endRow) {
        const std::size_t end = endRow * loop.width();
        const bool isLast = chunk + 1 == chunks.size();
        const std::uint64_t last = isLast ? spare : due(before[chunk + 1]); // given when the chunk is done
        double wanted = before[chunk];
        std::uint64_t given = due(wanted);
        for (std::size_t i = firstRow * loop.width(); i < end; ++i) {
            wanted += wantedBy(i);
            const std::uint64_t now = i + 1 == end ? last : std::clamp(due(wanted), given, last);
            counts[i] = minimum + static_cast<std::uint32_t>(now - given);
            given = now;
        }
    });
    return counts;
}

// Into the slots of a half's replicates.
void putCounts(const std::vector<std::uint32_t>& counts, std::uint32_t half, const Film& film, const RowLoop& loop,
               std::vector<std::uint32_t>& plan) {
    const std::uint32_t replicates = film.desc().replicates, shares = replicates / 2;
    loop.forEachChunk([&](std::size_t, std::size_t firstRow, std::size_t endRow) {
        for (std::size_t y = firstRow; y < endRow; ++y)
            for (std::size_t x = 0; x < loop.width(); ++x) {
                const std::uint32_t count = counts[y * loop.width() + x];
                const std::size_t tile = y / kTile * film.tilesX() + x / kTile;
                const std::size_t pixel = y % kTile * kTile + x % kTile;
                for (std::uint32_t share = 0; share < shares; ++share) {
                    const std::size_t slot = tile * replicates + 2 * share + half;
                    plan[slot * Film::kTilePixels + pixel] = (count + shares - 1 - share) / shares;
                }
            }
    });
}

} // namespace

std::uint32_t pilotSamples(std::uint32_t spp) {
    const std::uint32_t pilot = std::bit_floor(spp / 4);
    const bool fits = spp <= Film::kMaxSamples / kMax; // whatever a pixel gets
    return pilot < kMinPilot || !fits ? 0 : 2 * pilot;
}

std::vector<std::uint32_t> makeSamplePlan(const Film& film, std::uint32_t spp, std::uint32_t dependentSide,
                                          const PlanWork& work) {
    const RowLoop loop(film.desc(), work);
    const std::uint64_t pixels = std::uint64_t{film.desc().width} * film.desc().height;
    std::vector<std::uint32_t> plan(std::size_t{film.tileCount()} * film.desc().replicates * Film::kTilePixels);
    try {
        for (std::uint32_t half = 0; half < 2; ++half) {
            const std::uint64_t samples = (spp + 1 - half) / 2; // sample s of a pixel is one of half s mod 2
            const Noise noise = noiseOf(film, 1 - half, loop);
            const std::vector<float> importance = importanceOf(noise, dependentSide, loop);
            putCounts(allocate(importance, pilotSamples(spp) / 2, samples * pixels, loop), half, film, loop, plan);
        }
    } catch (const Cancelled&) {
        return {};
    }
    return plan;
}

std::uint64_t goalOf(const Film& film, std::uint32_t spp) {
    if (film.hasPlan()) return std::uint64_t{film.planEnd()} * film.desc().replicates;
    return film.isPilot() ? pilotSamples(spp) : spp;
}

} // namespace rt::image
