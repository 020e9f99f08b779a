#include "Common/Image/Denoise/Denoiser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "Common/Core/Parallel.h"
#include "Common/Image/Denoise/Blended.h"
#include "Common/Image/Denoise/DenoiseFilter.h"
#include "Common/Image/Denoise/Mix.h"
#include "Common/Image/Denoise/Planes.h"
#include "Common/Image/Metrics.h"
#include "Common/Shared/Denoise/DenoiseFit.h"
#include "Common/Shared/Denoise/DenoiseMix.h"

namespace rt::image {
namespace {

constexpr double kFormulaError = 0.1; // of the formula for the error, beside its noise

Half makeHalf(const Image& image, std::size_t threads) {
    Half half;
    for (std::size_t c = 0; c < 3; ++c) {
        half.radiance[c] = half.tones[c] = Plane(image.width, image.height);
        parallelFor(threads, image.height, [&](std::size_t y) {
            for (std::size_t x = 0; x < image.width; ++x) {
                const float value = image.data[(y * image.width + x) * 3 + c];
                const float radiance = shared::denoiseRadiance(value);
                half.radiance[c].row(y)[x] = radiance;
                half.tones[c].row(y)[x] = shared::denoiseTone(radiance);
            }
        });
    }
    return half;
}

// ---- choosing ------------------------------------------------------------------------------------------------------

// Of each pixel by the means around it: sums of rows, with and without what is nearest, then of these.
Plane choiceErrors(const Plane& errors, std::size_t threads) {
    constexpr std::size_t kReach = shared::kDenoiseChoiceReach, kOwn = shared::kDenoiseOwnReach;
    const std::size_t width = errors.width(), height = errors.height();
    Plane rowSums(width, height), otherSums = rowSums, result = rowSums;
    parallelFor(threads, height, [&](std::size_t y) {
        for (std::size_t x = 0; x < width; ++x) {
            const InReach all(x, kReach, width), own(x, kOwn, width);
            for (std::size_t from = all.first; from <= all.last; ++from) {
                rowSums.row(y)[x] += errors.row(y)[from];
                if (!own.contains(from)) otherSums.row(y)[x] += errors.row(y)[from];
            }
        }
    });
    parallelFor(threads, height, [&](std::size_t y) {
        const InReach rows(y, kReach, height), ownRows(y, kOwn, height);
        for (std::size_t x = 0; x < width; ++x) {
            float sum = 0, others = 0;
            for (std::size_t from = rows.first; from <= rows.last; ++from) {
                sum += rowSums.row(from)[x];
                others += (ownRows.contains(from) ? otherSums : rowSums).row(from)[x];
            }
            const std::size_t count = rows.count() * InReach(x, kReach, width).count();
            const std::size_t otherCount = count - ownRows.count() * InReach(x, kOwn, width).count();
            const float mean = sum / static_cast<float>(count);
            result.row(y)[x] =
                otherCount > 0 ? shared::denoiseChoiceError(mean, others / static_cast<float>(otherCount)) : mean;
        }
    });
    return result;
}

// Adds a row of errors of one channel, in tones, of each pixel's own noise.
void addToneErrors(const std::array<const float*, 2>& filtered, const std::array<const float*, 2>& tones,
                   const std::array<const float*, 2>& ownFactors, std::size_t width, float* errors) {
    for (std::size_t x = 0; x < width; ++x) {
        const shared::DenoisedValue a{shared::denoiseTone(filtered[0][x]), tones[0][x], ownFactors[0][x], 0};
        const shared::DenoisedValue b{shared::denoiseTone(filtered[1][x]), tones[1][x], ownFactors[1][x], 0};
        errors[x] += shared::denoiseError(a, b, 0);
    }
}

// The error of a filter by which it is chosen.
Plane filterErrors(const Halves& halves, std::size_t filter, std::size_t threads) {
    Plane errors(halves.variance.width(), halves.variance.height());
    const auto& own = halves.ownFactors[filter];
    parallelFor(threads, errors.height(), [&](std::size_t y) {
        for (std::size_t c = 0; c < 3; ++c)
            addToneErrors({halves.filtered[filter][0][c].row(y), halves.filtered[filter][1][c].row(y)},
                          {halves.half[0].tones[c].row(y), halves.half[1].tones[c].row(y)},
                          {own[0].row(y), own[1].row(y)}, errors.width(), errors.row(y));
    });
    return choiceErrors(errors, threads);
}

// The error of pixels as they are, to be compared with filterErrors().
Plane rawErrors(const Halves& halves, std::size_t threads) {
    Plane errors(halves.variance.width(), halves.variance.height());
    parallelFor(threads, errors.height(), [&](std::size_t y) {
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t x = 0; x < errors.width(); ++x) {
                const shared::DenoisedValue a = rawValue(halves.half[0].tones[c].row(y)[x]);
                const shared::DenoisedValue b = rawValue(halves.half[1].tones[c].row(y)[x]);
                errors.row(y)[x] += shared::kDenoiseRawCaution * shared::denoiseError(a, b, 0);
            }
    });
    return choiceErrors(errors, threads);
}

// 1 for the candidate of the least error.
Choice choose(const Halves& halves, std::size_t threads) {
    const std::size_t width = halves.variance.width(), height = halves.variance.height();
    const std::size_t candidates = halves.mayStayRaw() ? kDenoiseCandidates : kRawCandidate;
    Choice errors, chosen;
    for (std::size_t i = 0; i < kRawCandidate; ++i) errors[i] = filterErrors(halves, i, threads);
    if (halves.mayStayRaw()) errors[kRawCandidate] = rawErrors(halves, threads);
    for (Plane& plane : chosen) plane = Plane(width, height);
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            std::size_t best = 0;
            for (std::size_t i = 1; i < candidates; ++i)
                if (errors[i].row(y)[x] < errors[best].row(y)[x]) best = i;
            chosen[best].row(y)[x] = 1;
        }
    return chosen;
}

double meanOf(const Plane& plane) {
    double sum = 0;
    for (std::size_t y = 0; y < plane.height(); ++y)
        for (std::size_t x = 0; x < plane.width(); ++x) sum += plane.row(y)[x];
    return sum / (static_cast<double>(plane.width()) * static_cast<double>(plane.height()));
}

// ---- the result ----------------------------------------------------------------------------------------------------

// One row of it, and of the squared errors.
DenoiseErrorSums finishRow(const Halves& halves, const Choice& weights, std::size_t row, Denoised& result,
                           Planes& errors) {
    DenoiseErrorSums sums;
    const auto y = static_cast<std::uint32_t>(row);
    for (std::uint32_t x = 0; x < result.picture.width; ++x) {
        double pixel = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const Blended value = blendedAt(halves, weights, c, x, y);
            result.halfA.pixel(x, y)[c] = value.a.filtered;
            result.halfB.pixel(x, y)[c] = value.b.filtered;
            result.picture.pixel(x, y)[c] = value.mean;
            errors[c].row(y)[x] = value.error;
            const double unit = 1 / (double{value.mean} * value.mean + kRelativeFloor);
            pixel += value.error * unit;
            sums.minimum += value.noise * unit;
        }
        for (std::size_t i = 0; i < kDenoiseCandidates; ++i)
            *result.bandwidth.pixel(x, y) += weights[i].row(y)[x] * static_cast<float>(i);
        sums.errors += pixel;
        sums.squares += pixel * pixel;
    }
    return sums;
}

// By what the pixels around chose, so that no seam is seen where the choice changes.
Choice blend(const Choice& chosen, std::size_t threads) {
    Choice weights;
    for (std::size_t i = 0; i < kDenoiseCandidates; ++i)
        weights[i] = boxMean(chosen[i], shared::kDenoiseBlendReach, threads);
    const Plane raw = boxMean(chosen[kRawCandidate], shared::kDenoiseRawBlendReach, threads);
    for (std::size_t y = 0; y < raw.height(); ++y)
        for (std::size_t x = 0; x < raw.width(); ++x) {
            const float newRaw = raw.row(y)[x];
            const float scale = shared::denoiseFilterScale(weights[kRawCandidate].row(y)[x], newRaw);
            for (std::size_t i = 0; i < kRawCandidate; ++i) weights[i].row(y)[x] *= scale;
            weights[kRawCandidate].row(y)[x] = newRaw;
        }
    return weights;
}

void finish(const Halves& halves, Denoised& result, std::size_t threads) {
    Choice weights = blend(choose(halves, threads), threads);
    if (halves.isMixed()) mixWithRaw(halves, weights, threads);
    for (std::size_t i = 0; i < kDenoiseCandidates; ++i) result.shares[i] = meanOf(weights[i]);
    const std::size_t width = result.picture.width, height = result.picture.height;
    Planes errors{Plane(width, height), Plane(width, height), Plane(width, height)};
    std::vector<DenoiseErrorSums> rows(height);
    parallelFor(threads, height, [&](std::size_t y) { rows[y] = finishRow(halves, weights, y, result, errors); });
    DenoiseErrorSums sums;
    for (const DenoiseErrorSums& row : rows) sums += row;
    if (halves.isGivenBack()) giveBack(halves, result, threads);
    result.relmse = denoisedRelMse(sums, width * height, halves.dependentSide);
    for (std::size_t c = 0; c < 3; ++c) {
        errors[c] = boxMean(errors[c], shared::kDenoiseErrorReach, threads);
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x) result.error.pixel(x, y)[c] = std::max(errors[c].row(y)[x], 0.0f);
    }
}

// Of a tone of a half, summed over the channels.
Plane toneVariance(const Halves& halves, std::size_t threads) {
    Plane variance(halves.half[0].tones[0].width(), halves.half[0].tones[0].height());
    parallelFor(threads, variance.height(), [&](std::size_t y) {
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t x = 0; x < variance.width(); ++x) {
                const float difference = halves.half[0].tones[c].row(y)[x] - halves.half[1].tones[c].row(y)[x];
                variance.row(y)[x] += 0.5f * difference * difference;
            }
    });
    return boxMean(variance, shared::kDenoiseVarianceReach, threads);
}

} // namespace

RelMseEstimate denoisedRelMse(const DenoiseErrorSums& sums, std::uint64_t pixels, std::uint32_t dependentSide) {
    const double values = 3.0 * static_cast<double>(pixels);
    const double value = std::max(sums.errors, sums.minimum);
    return {value / values, std::hypot(dependentSide * std::sqrt(sums.squares), kFormulaError * value) / values};
}

Denoised denoise(const DenoiseInput& input, std::uint32_t dependentSide, std::size_t threads) {
    const std::uint32_t width = input.halfA.width, height = input.halfA.height;
    Halves halves;
    halves.half[0] = makeHalf(input.halfA, threads);
    halves.half[1] = makeHalf(input.halfB, threads);
    halves.dependentSide = dependentSide;
    halves.samplesOfHalf = input.samplesOfHalf;
    halves.variance = toneVariance(halves, threads);
    filterHalves(halves, input, threads);

    Denoised result;
    for (Image* image : {&result.picture, &result.halfA, &result.halfB, &result.error}) *image = Image(width, height);
    result.bandwidth = Image(width, height, 1);
    finish(halves, result, threads);
    return result;
}

} // namespace rt::image
