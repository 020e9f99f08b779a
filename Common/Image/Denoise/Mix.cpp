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

// Sums over each cell of what mixRow(y, mixes) writes for the pixels of a row.
class MixCells {
  public:
    template <class MixRow>
    MixCells(std::size_t width, std::size_t height, std::size_t threads, const MixRow& mixRow)
        : gain_((width + kCellSide - 1) / kCellSide, (height + kCellSide - 1) / kCellSide),
          change_(gain_.width(), gain_.height()) {
        parallelFor(threads, gain_.height(), [&](std::size_t row) {
            std::vector<shared::DenoiseMix> mixes(width);
            for (std::size_t y = row * kCellSide; y < std::min(height, (row + 1) * kCellSide); ++y) {
                std::fill(mixes.begin(), mixes.end(), shared::DenoiseMix{0, 0});
                mixRow(y, mixes);
                for (std::size_t x = 0; x < width; ++x) {
                    gain_.row(row)[x / kCellSide] += mixes[x].gain;
                    change_.row(row)[x / kCellSide] += mixes[x].change;
                }
            }
        });
    }

    float share(std::size_t x, std::size_t y) const {
        const shared::DenoiseCellPlace column = shared::denoiseCellPlace(static_cast<int>(x)),
                                       row = shared::denoiseCellPlace(static_cast<int>(y));
        return shared::denoiseMixShare({interpolated(gain_, column, row), interpolated(change_, column, row)});
    }

  private:
    static float interpolated(const Plane& cells, const shared::DenoiseCellPlace& x,
                              const shared::DenoiseCellPlace& y) {
        const auto at = [&cells](int column, int row) {
            column = std::clamp(column, 0, static_cast<int>(cells.width()) - 1);
            return cells.row(
                static_cast<std::size_t>(std::clamp(row, 0, static_cast<int>(cells.height()) - 1)))[column];
        };
        const auto inRow = [&](int row) { return std::lerp(at(x.first, row), at(x.first + 1, row), x.fraction); };
        return std::lerp(inRow(y.first), inRow(y.first + 1), y.fraction);
    }

    Plane gain_, change_;
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

void mixWithRaw(const Halves& halves, Choice& weights, std::size_t threads) {
    const std::size_t width = halves.variance.width(), height = halves.variance.height();
    const MixCells cells(width, height, threads, [&](std::size_t y, std::vector<shared::DenoiseMix>& mixes) {
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
        for (std::size_t x = 0; x < width; ++x) {
            const float share = cells.share(x, y);
            for (Plane& weight : weights) weight.row(y)[x] *= share;
            weights[kRawCandidate].row(y)[x] += 1 - share;
        }
    });
}

void giveBack(const Halves& halves, Denoised& result, std::size_t threads) {
    const std::uint32_t width = result.picture.width, height = result.picture.height;
    std::array<CoarseResiduals, 3> residuals{CoarseResiduals(halves, result, 0, threads),
                                             CoarseResiduals(halves, result, 1, threads),
                                             CoarseResiduals(halves, result, 2, threads)};
    const MixCells cells(width, height, threads, [&](std::size_t y, std::vector<shared::DenoiseMix>& mixes) {
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
        for (std::uint32_t x = 0; x < width; ++x) {
            const float share = cells.share(x, y);
            for (std::size_t c = 0; c < 3; ++c) {
                float &a = result.halfA.pixel(x, y)[c], &b = result.halfB.pixel(x, y)[c];
                a = shared::denoiseGivenBack(a, share * residuals[c].a().row(y)[x]);
                b = shared::denoiseGivenBack(b, share * residuals[c].b().row(y)[x]);
                result.picture.pixel(x, y)[c] = 0.5f * (a + b);
            }
        }
    });
}

} // namespace rt::image
