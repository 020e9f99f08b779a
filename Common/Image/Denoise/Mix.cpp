#include "Common/Image/Denoise/Mix.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "Common/Core/Parallel.h"
#include "Common/Shared/Denoise/DenoiseMix.h"

namespace rt::image {
namespace {

constexpr std::size_t kCellSide = shared::kDenoiseCell;

// Sums over the pixels of each cell and level of noise.
class MixCells {
  public:
    // mixRow(y, mixes) writes those of the pixels of a row.
    template <class MixRow>
    MixCells(const Plane& variance, std::size_t threads, const MixRow& mixRow)
        : variance_(variance),
          columns_((variance.width() + kCellSide - 1) / kCellSide),
          rows_((variance.height() + kCellSide - 1) / kCellSide),
          sums_(columns_ * rows_) {
        const std::size_t width = variance.width(), height = variance.height();
        parallelFor(threads, rows_, [&](std::size_t row) {
            std::vector<shared::DenoiseMix> mixes(width);
            for (std::size_t y = row * kCellSide; y < std::min(height, (row + 1) * kCellSide); ++y) {
                std::fill(mixes.begin(), mixes.end(), shared::DenoiseMix{0, 0});
                mixRow(y, mixes);
                for (std::size_t x = 0; x < width; ++x)
                    add(mixes[x], noiseLevel(x, y), sums_[row * columns_ + x / kCellSide]);
            }
        });
    }

    // Of the pixels of a row.
    std::vector<float> shares(std::size_t y) const {
        const shared::DenoiseCellPlace row = shared::denoiseCellPlace(static_cast<int>(y));
        std::vector<Sums> cells(columns_); // between the two rows of cells that the pixels lie between
        for (std::size_t x = 0; x < columns_; ++x)
            for (std::size_t level = 0; level < Sums().size(); ++level)
                cells[x][level] = lerp(cell(x, row.first)[level], cell(x, row.first + 1)[level], row.fraction);
        std::vector<float> shares(variance_.width());
        for (std::size_t x = 0; x < shares.size(); ++x) {
            const shared::DenoiseCellPlace column = shared::denoiseCellPlace(static_cast<int>(x));
            const float level = noiseLevel(x, y);
            shares[x] =
                shared::denoiseMixShare(lerp(part(cells[clamped(column.first, columns_)], level),
                                             part(cells[clamped(column.first + 1, columns_)], level), column.fraction));
        }
        return shares;
    }

  private:
    using Sums = std::array<shared::DenoiseMix, shared::kDenoiseNoiseLevels>;

    float noiseLevel(std::size_t x, std::size_t y) const { return shared::denoiseNoiseLevel(variance_.row(y)[x]); }

    static void add(const shared::DenoiseMix& mix, float noiseLevel, Sums& sums) {
        for (const auto& [level, share] : partsOf(noiseLevel)) {
            sums[level].gain += share * mix.gain;
            sums[level].change += share * mix.change;
        }
    }
    static shared::DenoiseMix part(const Sums& sums, float noiseLevel) {
        shared::DenoiseMix result{0, 0};
        for (const auto& [level, share] : partsOf(noiseLevel)) {
            result.gain += share * sums[level].gain;
            result.change += share * sums[level].change;
        }
        return result;
    }

    // How far a pixel counts for each of the two levels of noise that its own lies between.
    struct LevelPart {
        std::size_t level;
        float share;
    };
    static std::array<LevelPart, 2> partsOf(float noiseLevel) {
        const int lower = std::min(static_cast<int>(noiseLevel), shared::kDenoiseNoiseLevels - 2);
        const auto of = [&](int level) {
            return LevelPart{static_cast<std::size_t>(level), shared::denoisePartOfLevel(noiseLevel, level)};
        };
        return {of(lower), of(lower + 1)};
    }

    static shared::DenoiseMix lerp(const shared::DenoiseMix& a, const shared::DenoiseMix& b, float t) {
        return {std::lerp(a.gain, b.gain, t), std::lerp(a.change, b.change, t)};
    }

    // The number of a column or row of cells; of one outside of the image, that at its edge.
    static std::size_t clamped(int cell, std::size_t count) {
        return static_cast<std::size_t>(std::clamp(cell, 0, static_cast<int>(count) - 1));
    }
    const Sums& cell(std::size_t column, int row) const { return sums_[clamped(row, rows_) * columns_ + column]; }

    const Plane& variance_;
    std::size_t columns_, rows_;
    std::vector<Sums> sums_;
};

void add(shared::DenoiseMix& sum, const shared::DenoiseMix& mix) {
    sum.gain += mix.gain;
    sum.change += mix.change;
}

// Of one channel, means over the pixels around each: of what the filter took away from both halves, and of half of the
// difference of the raw ones.
struct CoarseResiduals {
    std::array<Plane, 3> planes;
    Plane& a() { return planes[0]; }
    Plane& b() { return planes[1]; }
    Plane& halfDifference() { return planes[2]; }

    CoarseResiduals(const Halves& halves, const Denoised& filtered, std::size_t channel, std::size_t threads);
};

CoarseResiduals::CoarseResiduals(const Halves& halves, const Denoised& filtered, std::size_t channel,
                                 std::size_t threads) {
    const std::size_t width = filtered.picture.width, height = filtered.picture.height;
    for (Plane& plane : planes) plane = halves.half[0].radiance[channel].alike();
    parallelFor(threads, height, [&](std::size_t y) {
        const float *rawA = halves.half[0].radiance[channel].row(y), *rawB = halves.half[1].radiance[channel].row(y);
        const float *filteredA = &filtered.halfA.data[y * width * 3 + channel],
                    *filteredB = &filtered.halfB.data[y * width * 3 + channel];
        float *rowA = a().row(y), *rowB = b().row(y), *rowDifference = halfDifference().row(y);
        for (std::size_t x = 0; x < width; ++x) {
            rowA[x] = rawA[x] - filteredA[x * 3];
            rowB[x] = rawB[x] - filteredB[x * 3];
            rowDifference[x] = 0.5f * (rawA[x] - rawB[x]);
        }
    });
    boxMeans(planes, shared::kDenoiseCoarseReach, threads);
}

} // namespace

void mixWithRaw(const Halves& halves, CandidateWeights& weights, std::size_t threads) {
    const std::size_t width = halves.variance.width(), height = halves.variance.height();
    const MixCells cells(halves.variance, threads, [&](std::size_t y, std::vector<shared::DenoiseMix>& mixes) {
        BlendedRow row(halves, weights, y);
        for (std::size_t c = 0; c < 3; ++c) {
            row.blend(c);
            for (std::size_t x = 0; x < width; ++x) {
                const Blended pixel = row.at(x);
                add(mixes[x], shared::denoiseMix(pixel.a, pixel.b, pixel.error));
            }
        }
    });
    parallelFor(threads, height, [&](std::size_t y) {
        const std::vector<float> shares = cells.shares(y);
        for (std::size_t x = 0; x < width; ++x) {
            for (Plane& weight : weights) weight.row(y)[x] *= shares[x];
            weights[kRawCandidate].row(y)[x] += 1 - shares[x];
        }
    });
}

void giveBack(const Halves& halves, Denoised& result, std::size_t threads) {
    const std::uint32_t width = result.picture.width, height = result.picture.height;
    std::array<CoarseResiduals, 3> residuals{CoarseResiduals(halves, result, 0, threads),
                                             CoarseResiduals(halves, result, 1, threads),
                                             CoarseResiduals(halves, result, 2, threads)};
    const MixCells cells(halves.variance, threads, [&](std::size_t y, std::vector<shared::DenoiseMix>& mixes) {
        const float* picture = &result.picture.data[y * width * 3];
        for (std::size_t c = 0; c < 3; ++c) {
            const float *a = residuals[c].a().row(y), *b = residuals[c].b().row(y),
                        *halfDifference = residuals[c].halfDifference().row(y);
            for (std::size_t x = 0; x < width; ++x)
                add(mixes[x], shared::denoiseCoarseMix(a[x], b[x], halfDifference[x], picture[x * 3 + c]));
        }
    });
    parallelFor(threads, height, [&](std::size_t row) {
        const auto y = static_cast<std::uint32_t>(row);
        const std::vector<float> shares = cells.shares(y);
        for (std::uint32_t x = 0; x < width; ++x) {
            for (std::size_t c = 0; c < 3; ++c) {
                float &a = result.halfA.pixel(x, y)[c], &b = result.halfB.pixel(x, y)[c];
                a = shared::denoiseGivenBack(a, shares[x] * residuals[c].a().row(y)[x]);
                b = shared::denoiseGivenBack(b, shares[x] * residuals[c].b().row(y)[x]);
                result.picture.pixel(x, y)[c] = 0.5f * (a + b);
            }
        }
    });
}

} // namespace rt::image
