#include "Common/Image/Denoise/Denoiser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "Common/Core/Parallel.h"
#include "Common/Image/Denoise/Blended.h"
#include "Common/Image/Denoise/Choice.h"
#include "Common/Image/Denoise/DenoiseFilter.h"
#include "Common/Image/Denoise/Mix.h"
#include "Common/Image/Denoise/Planes.h"
#include "Common/Image/Metrics.h"
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

// ---- the result ----------------------------------------------------------------------------------------------------

// Over one row of it, or over all.
struct ResultSums {
    DenoiseErrorSums errors;
    std::array<double, kDenoiseCandidates> weights{};
};

// One row of it; where there are planes for squared errors, of these and of the bandwidth, too.
ResultSums finishRow(const Halves& halves, const CandidateWeights& weights, std::size_t y, Denoised& result,
                     Planes* errors) {
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

void storeErrors(Planes& errors, Image& result, std::size_t threads) {
    boxMeans(errors, shared::kDenoiseErrorReach, threads);
    parallelFor(threads, result.height, [&](std::size_t y) {
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t x = 0; x < result.width; ++x)
                result.data[(y * result.width + x) * 3 + c] = std::max(errors[c].row(y)[x], 0.0f);
    });
}

void finish(Halves& halves, Denoised& result, std::size_t threads, bool details) {
    CandidateWeights weights = choose(halves, threads);
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
