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

Half makeHalf(const Image& image, const Plane& like, std::size_t threads) {
    Half half;
    for (std::size_t c = 0; c < 3; ++c) {
        half.radiance[c] = like.alike();
        half.tones[c] = like.alike();
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

// What one candidate after another needs to find its errors: of single pixels, what is summed of them, and means.
struct ErrorPlanes {
    Plane errors, rowSums, otherSums, means;
};

// Of each pixel by the means around it: sums of rows, with and without what is nearest, then of these.
void averageErrors(ErrorPlanes& planes, std::size_t threads) {
    constexpr int kReach = shared::kDenoiseChoiceReach, kOwn = shared::kDenoiseOwnReach;
    const std::size_t width = planes.errors.width(), height = planes.errors.height();
    parallelFor(threads, height, [&](std::size_t y) {
        const float* errors = planes.errors.row(y);
        float *all = planes.rowSums.row(y), *others = planes.otherSums.row(y);
        std::fill_n(all, width, 0.0f);
        std::fill_n(others, width, 0.0f);
        for (int shift = -kReach; shift <= kReach; ++shift) {
            addShifted(errors, shift, width, all);
            if (shift < -kOwn || shift > kOwn) addShifted(errors, shift, width, others);
        }
    });
    parallelFor(threads, height, [&](std::size_t y) {
        const InReach rows(y, kReach, height), ownRows(y, kOwn, height);
        std::vector<float> others(width, 0.0f);
        float* all = planes.means.row(y);
        std::fill_n(all, width, 0.0f);
        for (std::size_t from = rows.first; from <= rows.last; ++from) {
            addShifted(planes.rowSums.row(from), 0, width, all);
            addShifted((ownRows.contains(from) ? planes.otherSums : planes.rowSums).row(from), 0, width, others.data());
        }
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t count = rows.count() * InReach(x, kReach, width).count();
            const std::size_t otherCount = count - ownRows.count() * InReach(x, kOwn, width).count();
            const float mean = all[x] / static_cast<float>(count);
            all[x] =
                otherCount > 0 ? shared::denoiseChoiceError(mean, others[x] / static_cast<float>(otherCount)) : mean;
        }
    });
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

// A row of the errors of a filter by which it is chosen.
void filterErrors(const Halves& halves, std::size_t filter, std::size_t y, float* errors) {
    const auto& own = halves.ownFactors[filter];
    for (std::size_t c = 0; c < 3; ++c)
        addToneErrors({halves.filtered[filter][0][c].row(y), halves.filtered[filter][1][c].row(y)},
                      {halves.half[0].tones[c].row(y), halves.half[1].tones[c].row(y)}, {own[0].row(y), own[1].row(y)},
                      halves.variance.width(), errors);
}

// A row of the errors of pixels as they are, to be compared with filterErrors().
void rawErrors(const Halves& halves, std::size_t y, float* errors) {
    for (std::size_t c = 0; c < 3; ++c) {
        const float *a = halves.half[0].tones[c].row(y), *b = halves.half[1].tones[c].row(y);
        for (std::size_t x = 0; x < halves.variance.width(); ++x)
            errors[x] += shared::kDenoiseRawCaution * shared::denoiseError(rawValue(a[x]), rawValue(b[x]), 0);
    }
}

// 1 for the candidate of the least error.
Choice choose(const Halves& halves, std::size_t threads) {
    const std::size_t width = halves.variance.width(), height = halves.variance.height();
    const std::size_t candidates = halves.mayStayRaw() ? kDenoiseCandidates : kRawCandidate;
    const Plane& like = halves.variance;
    ErrorPlanes planes{like.alike(), like.alike(), like.alike(), like.alike()};
    Plane best = like.alike(), least = like.alike(); // candidate, and its error
    for (std::size_t i = 0; i < candidates; ++i) {
        parallelFor(threads, height, [&](std::size_t y) {
            float* errors = planes.errors.row(y);
            std::fill_n(errors, width, 0.0f);
            if (i == kRawCandidate)
                rawErrors(halves, y, errors);
            else
                filterErrors(halves, i, y, errors);
        });
        averageErrors(planes, threads);
        parallelFor(threads, height, [&](std::size_t y) {
            for (std::size_t x = 0; x < width; ++x)
                if (const float error = planes.means.row(y)[x]; i == 0 || error < least.row(y)[x]) {
                    least.row(y)[x] = error;
                    best.row(y)[x] = static_cast<float>(i);
                }
        });
    }
    Choice chosen;
    for (Plane& plane : chosen) plane = like.alike();
    parallelFor(threads, height, [&](std::size_t y) {
        for (std::size_t i = 0; i < kDenoiseCandidates; ++i)
            for (std::size_t x = 0; x < width; ++x)
                chosen[i].row(y)[x] = best.row(y)[x] == static_cast<float>(i) ? 1.0f : 0.0f;
    });
    return chosen;
}

// ---- the result ----------------------------------------------------------------------------------------------------

// Over one row of it, or over all.
struct ResultSums {
    DenoiseErrorSums errors;
    std::array<double, kDenoiseCandidates> weights{};
};

// One row of it; where there are planes for squared errors, of these and of the bandwidth, too.
ResultSums finishRow(const Halves& halves, const Choice& weights, std::size_t y, Denoised& result, Planes* errors) {
    const std::size_t width = result.picture.width;
    ResultSums sums;
    std::vector<double> pixelErrors(width, 0.0);
    BlendedRow row(halves, weights, y);
    for (std::size_t c = 0; c < 3; ++c) {
        row.blend(c);
        for (std::size_t x = 0, at = y * width * 3 + c; x < width; ++x, at += 3) {
            const Blended value = row.at(x);
            result.halfA.data[at] = value.a.filtered;
            result.halfB.data[at] = value.b.filtered;
            result.picture.data[at] = value.mean;
            if (errors != nullptr) (*errors)[c].row(y)[x] = value.error;
            const double unit = 1 / (double{value.mean} * value.mean + kRelativeFloor);
            pixelErrors[x] += value.error * unit;
            sums.errors.minimum += value.noise * unit;
        }
    }
    for (const double pixel : pixelErrors) {
        sums.errors.errors += pixel;
        sums.errors.squares += pixel * pixel;
    }
    for (std::size_t i = 0; i < kDenoiseCandidates; ++i)
        for (std::size_t x = 0; x < width; ++x) {
            const float weight = weights[i].row(y)[x];
            if (errors != nullptr) result.bandwidth.data[y * width + x] += weight * static_cast<float>(i);
            sums.weights[i] += weight;
        }
    return sums;
}

// By what the pixels around chose, so that no seam is seen where the choice changes.
Choice blend(Choice weights, std::size_t threads) {
    const std::size_t width = weights[kRawCandidate].width(), height = weights[kRawCandidate].height();
    Plane raw = weights[kRawCandidate].alike();
    for (std::size_t y = 0; y < height; ++y) std::copy_n(weights[kRawCandidate].row(y), width, raw.row(y));
    boxMeans({&raw, 1}, shared::kDenoiseRawBlendReach, threads);
    boxMeans(weights, shared::kDenoiseBlendReach, threads);
    parallelFor(threads, height, [&](std::size_t y) {
        for (std::size_t x = 0; x < width; ++x) {
            const float newRaw = raw.row(y)[x];
            const float scale = shared::denoiseFilterScale(weights[kRawCandidate].row(y)[x], newRaw);
            for (std::size_t i = 0; i < kRawCandidate; ++i) weights[i].row(y)[x] *= scale;
            weights[kRawCandidate].row(y)[x] = newRaw;
        }
    });
    return weights;
}

void storeErrors(Planes& errors, Image& result, std::size_t threads) {
    boxMeans(errors, shared::kDenoiseErrorReach, threads);
    parallelFor(threads, result.height, [&](std::size_t y) {
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t x = 0; x < result.width; ++x)
                result.data[(y * result.width + x) * 3 + c] = std::max(errors[c].row(y)[x], 0.0f);
    });
}

void finish(Halves& halves, Denoised& result, std::size_t threads, bool details) {
    Choice weights = blend(choose(halves, threads), threads);
    if (halves.isMixed()) mixWithRaw(halves, weights, threads);
    const std::size_t width = result.picture.width, height = result.picture.height, pixels = width * height;
    Planes errors;
    if (details) {
        for (Plane& plane : errors) plane = halves.variance.alike();
        result.bandwidth = Image(result.picture.width, result.picture.height, 1);
    }
    std::vector<ResultSums> rows(height);
    parallelFor(threads, height,
                [&](std::size_t y) { rows[y] = finishRow(halves, weights, y, result, details ? &errors : nullptr); });
    DenoiseErrorSums sums;
    for (const ResultSums& row : rows) {
        sums += row.errors;
        for (std::size_t i = 0; i < kDenoiseCandidates; ++i)
            result.shares[i] += row.weights[i] / static_cast<double>(pixels);
    }
    for (auto& candidate : halves.filtered) candidate = {}; // what is made next takes their memory
    if (halves.isGivenBack()) giveBack(halves, result, threads);
    result.relmse = denoisedRelMse(sums, pixels, halves.dependentSide);
    if (!details) {
        result.halfA = result.halfB = {};
        return;
    }
    result.error = Image(result.picture.width, result.picture.height);
    storeErrors(errors, result.error, threads);
}

// Adds that of a tone of a half, over the channels, to a plane of zeros.
void addToneVariance(const Halves& halves, Plane& variance, std::size_t threads) {
    parallelFor(threads, variance.height(), [&](std::size_t y) {
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t x = 0; x < variance.width(); ++x) {
                const float difference = halves.half[0].tones[c].row(y)[x] - halves.half[1].tones[c].row(y)[x];
                variance.row(y)[x] += 0.5f * difference * difference;
            }
    });
    boxMeans({&variance, 1}, shared::kDenoiseVarianceReach, threads);
}

} // namespace

RelMseEstimate denoisedRelMse(const DenoiseErrorSums& sums, std::uint64_t pixels, std::uint32_t dependentSide) {
    const double values = 3.0 * static_cast<double>(pixels);
    const double value = std::max(sums.errors, sums.minimum);
    return {value / values, std::hypot(dependentSide * std::sqrt(sums.squares), kFormulaError * value) / values};
}

Denoised denoise(const DenoiseInput& input, std::uint32_t dependentSide, std::size_t threads, bool details) {
    const std::uint32_t width = input.halfA.width, height = input.halfA.height;
    Halves halves;
    halves.variance = Plane(width, height); // whose memory all planes share
    halves.half[0] = makeHalf(input.halfA, halves.variance, threads);
    halves.half[1] = makeHalf(input.halfB, halves.variance, threads);
    halves.dependentSide = dependentSide;
    halves.samplesOfHalf = input.samplesOfHalf;
    addToneVariance(halves, halves.variance, threads);
    filterHalves(halves, input, threads);

    Denoised result;
    for (Image* image : {&result.picture, &result.halfA, &result.halfB}) *image = Image(width, height);
    finish(halves, result, threads, details);
    return result;
}

} // namespace rt::image
