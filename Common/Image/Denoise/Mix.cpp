#include "Common/Image/Denoise/Mix.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "Common/Core/Parallel.h"
#include "Common/Shared/Denoise/DenoiseMix.h"

namespace rt::image {
namespace {

constexpr std::size_t kCellSide = shared::kDenoiseCell;

// Sums over each cell of what mixAt(x, y) returns.
class MixCells {
  public:
    template <class MixAt>
    MixCells(std::size_t width, std::size_t height, std::size_t threads, const MixAt& mixAt)
        : gain_((width + kCellSide - 1) / kCellSide, (height + kCellSide - 1) / kCellSide), change_(gain_) {
        parallelFor(threads, gain_.height(), [&](std::size_t row) {
            for (std::size_t y = row * kCellSide; y < std::min(height, (row + 1) * kCellSide); ++y)
                for (std::size_t x = 0; x < width; ++x) {
                    const shared::DenoiseMix mix = mixAt(x, y);
                    gain_.row(row)[x / kCellSide] += mix.gain;
                    change_.row(row)[x / kCellSide] += mix.change;
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
    Plane a, b, halfDifference;
};

CoarseResiduals coarseResiduals(const Halves& halves, const Denoised& filtered, std::size_t channel,
                                std::size_t threads) {
    const Plane &rawA = halves.half[0].radiance[channel], &rawB = halves.half[1].radiance[channel];
    CoarseResiduals single{Plane(rawA.width(), rawA.height()), Plane(rawA.width(), rawA.height()),
                           Plane(rawA.width(), rawA.height())};
    parallelFor(threads, rawA.height(), [&](std::size_t y) {
        for (std::size_t x = 0; x < rawA.width(); ++x) {
            const std::size_t at = (y * rawA.width() + x) * 3 + channel;
            single.a.row(y)[x] = rawA.row(y)[x] - filtered.halfA.data[at];
            single.b.row(y)[x] = rawB.row(y)[x] - filtered.halfB.data[at];
            single.halfDifference.row(y)[x] = 0.5f * (rawA.row(y)[x] - rawB.row(y)[x]);
        }
    });
    const auto mean = [threads](const Plane& plane) { return boxMean(plane, shared::kDenoiseCoarseReach, threads); };
    return {mean(single.a), mean(single.b), mean(single.halfDifference)};
}

} // namespace

void mixWithRaw(const Halves& halves, Choice& weights, std::size_t threads) {
    const std::size_t width = halves.variance.width(), height = halves.variance.height();
    const MixCells cells(width, height, threads, [&](std::size_t x, std::size_t y) {
        shared::DenoiseMix sum{0, 0};
        for (std::size_t c = 0; c < 3; ++c) {
            const Blended pixel = blendedAt(halves, weights, c, x, y);
            add(sum, shared::denoiseMix(pixel.a, pixel.b, pixel.error));
        }
        return sum;
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
    std::array<CoarseResiduals, 3> residuals;
    for (std::size_t c = 0; c < 3; ++c) residuals[c] = coarseResiduals(halves, result, c, threads);
    const MixCells cells(width, height, threads, [&](std::size_t x, std::size_t y) {
        shared::DenoiseMix sum{0, 0};
        for (std::size_t c = 0; c < 3; ++c)
            add(sum, shared::denoiseCoarseMix(residuals[c].a.row(y)[x], residuals[c].b.row(y)[x],
                                              residuals[c].halfDifference.row(y)[x],
                                              result.picture.data[(y * width + x) * 3 + c]));
        return sum;
    });
    parallelFor(threads, height, [&](std::size_t row) {
        const auto y = static_cast<std::uint32_t>(row);
        for (std::uint32_t x = 0; x < width; ++x) {
            const float share = cells.share(x, y);
            for (std::size_t c = 0; c < 3; ++c) {
                float &a = result.halfA.pixel(x, y)[c], &b = result.halfB.pixel(x, y)[c];
                a = shared::denoiseGivenBack(a, share * residuals[c].a.row(y)[x]);
                b = shared::denoiseGivenBack(b, share * residuals[c].b.row(y)[x]);
                result.picture.pixel(x, y)[c] = 0.5f * (a + b);
            }
        }
    });
}

} // namespace rt::image
