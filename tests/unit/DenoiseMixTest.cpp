// How much of the filter a picture keeps, against the optimum of known errors and against both pictures.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

#include "Common/Image/Denoise/Denoiser.h"
#include "Common/Image/Denoise/Mix.h"
#include "Common/Image/Metrics.h"
#include "Common/Shared/Denoise/DenoiseMix.h"
#include "tests/unit/DenoiseInputs.h"

namespace rt::test {
namespace {

constexpr std::uint32_t kMixSide = 96;

// The optimum for errors of raw halves of standard deviation `noise` and a filter that adds an error of its own, of
// standard deviation `spoiled`, and lets the share `through` of each half's noise pass: by calculus on
// E (w F + (1 - w) R - truth)^2.
double bestShare(double noise, double spoiled, double through) {
    const double raw = noise * noise / 2, filtered = spoiled * spoiled + through * through * raw;
    const double common = through * raw;
    return (raw - common) / (raw + filtered - 2 * common);
}

// Of both halves' noise and the filter's own error, of so many pixels: mixAt(a, b, own).
template <class MixAt>
double measuredShare(float noise, float spoiled, const MixAt& mixAt) {
    constexpr int kPixels = 200000;
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    shared::DenoiseMix sum{0, 0};
    for (int i = 0; i < kPixels; ++i) {
        const float a = noise * normal(random), b = noise * normal(random), own = spoiled * normal(random);
        const shared::DenoiseMix mix = mixAt(a, b, own);
        sum.gain += mix.gain;
        sum.change += mix.change;
    }
    return shared::denoiseMixShare(sum);
}

constexpr float kTruth = 0.5f;

double measuredMixShare(float noise, float spoiled, float through) {
    const float error = spoiled * spoiled + through * through * noise * noise / 2;
    return measuredShare(noise, spoiled, [&](float a, float b, float own) {
        return shared::denoiseMix({kTruth + through * a + own, kTruth + a, through, 0},
                                  {kTruth + through * b + own, kTruth + b, through, 0}, error);
    });
}

// Fixed seed. A share's standard deviation is below 0.005; units of relMSE, which vary with the pixel, shift it by less
// than that.
TEST(DenoiseMix, IsTheBestOfBothPictures) {
    for (const auto& [noise, spoiled, through] :
         {std::array{0.02f, 0.002f, 0.0f}, {0.02f, 0.02f, 0.0f}, {0.02f, 0.02f, 0.3f}, {0.01f, 0.03f, 0.1f}})
        EXPECT_NEAR(measuredMixShare(noise, spoiled, through), bestShare(noise, spoiled, through), 0.025)
            << noise << ", " << spoiled << ", " << through;
}

// The best part of a residual to be given back, of a filter as bestShare() has it, which is off by the same in both
// halves: by calculus on E (F + v (R - F) - truth)^2.
double bestCoarseShare(double noise, double spoiled, double through) {
    const double raw = noise * noise / 2, kept = 1 - through;
    return (spoiled * spoiled - through * kept * raw) / (kept * kept * raw + spoiled * spoiled);
}

double measuredCoarseShare(float noise, float spoiled, float through) {
    const float kept = 1 - through;
    return measuredShare(noise, spoiled, [&](float a, float b, float own) {
        return shared::denoiseCoarseMix(kept * a - own, kept * b - own, 0.5f * (a - b), kTruth + own);
    });
}

TEST(DenoiseMix, GivesBackThePartThatIsLeastOff) {
    for (const auto& [noise, spoiled, through] :
         {std::array{0.02f, 0.02f, 0.0f}, {0.02f, 0.01f, 0.0f}, {0.02f, 0.02f, 0.3f}, {0.01f, 0.03f, 0.1f}})
        EXPECT_NEAR(measuredCoarseShare(noise, spoiled, through), bestCoarseShare(noise, spoiled, through), 0.025)
            << noise << ", " << spoiled << ", " << through;
}

TEST(DenoiseMix, KeepsTheFilterThatChangesNothingAndIsAShare) {
    EXPECT_EQ(shared::denoiseMixShare({0, 0}), 1);
    EXPECT_EQ(shared::denoiseMixShare({-1, 2}), 0);
    EXPECT_EQ(shared::denoiseMixShare({3, 2}), 1);
    EXPECT_EQ(shared::denoiseMixShare({1, 2}), 0.5f);
}

// Between the middles of cells a place runs from one to the next, without a jump.
TEST(DenoiseMix, CellsAreInterpolated) {
    float last = -1;
    for (int pixel = 0; pixel < 100; ++pixel) {
        const shared::DenoiseCellPlace place = shared::denoiseCellPlace(pixel);
        EXPECT_TRUE(place.fraction >= 0 && place.fraction < 1);
        const float now = static_cast<float>(place.first) + place.fraction;
        EXPECT_NEAR(now - last, pixel == 0 ? 0.515625f : 0.03125f, 1e-6f);
        last = now;
    }
}

double relMseFrom(const image::Image& image, const image::Image& truth) {
    double sum = 0;
    for (std::size_t i = 0; i < image.data.size(); ++i) {
        const double value = truth.data[i], difference = image.data[i] - value;
        sum += difference * difference / (value * value + image::kRelativeFloor);
    }
    return sum / static_cast<double>(image.data.size());
}

// A texture that differs from pixel to pixel, which no feature knows, under little noise: what the filter spoils is as
// much as the noise. A picture without the mix, as one of so few samples is, loses more.
TEST(DenoiseMix, DetailsAreNotLost) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> detail(0.45f, 0.55f);
    const image::Image truth = picture(kMixSide, kMixSide, [&](auto, auto, auto) { return detail(random); });
    std::normal_distribution<float> noise(0, 0.03f);
    image::DenoiseInput input;
    for (image::Image* half : {&input.halfA, &input.halfB})
        *half =
            picture(kMixSide, kMixSide, [&](auto x, auto y, auto c) { return truth.pixel(x, y)[c] + noise(random); });
    image::Image raw = input.halfA;
    for (std::size_t i = 0; i < raw.data.size(); ++i) raw.data[i] = 0.5f * (raw.data[i] + input.halfB.data[i]);
    const double withoutMix = relMseFrom(image::denoise(input, 1).picture, truth);
    input.samplesOfHalf = 128;
    const double withMix = relMseFrom(image::denoise(input, 1).picture, truth);
    EXPECT_LT(withMix, relMseFrom(raw, truth));
    EXPECT_LT(withMix, 0.9 * withoutMix);
}

// Halves of `truth` with normal noise of a standard deviation that depends on the column, and a filter that has made
// grey of them.
struct Blurred {
    image::Halves halves;
    image::Denoised filtered;
};
template <class Deviation>
Blurred blurred(const image::Image& truth, const Deviation& deviationAt) {
    std::mt19937 random(3);
    std::normal_distribution<float> noise;
    Blurred result;
    result.halves.variance = image::Plane(truth.width, truth.height);
    for (std::uint32_t y = 0; y < truth.height; ++y)
        for (std::uint32_t x = 0; x < truth.width; ++x)
            result.halves.variance.row(y)[x] = 3 * deviationAt(x) * deviationAt(x);
    for (image::Half& half : result.halves.half)
        for (std::size_t c = 0; c < 3; ++c) {
            half.radiance[c] = image::Plane(truth.width, truth.height);
            for (std::uint32_t y = 0; y < truth.height; ++y)
                for (std::uint32_t x = 0; x < truth.width; ++x)
                    half.radiance[c].row(y)[x] = truth.pixel(x, y)[c] + deviationAt(x) * noise(random);
        }
    for (image::Image* image : {&result.filtered.picture, &result.filtered.halfA, &result.filtered.halfB})
        *image = picture(truth.width, truth.height, kGrey);
    return result;
}

const auto kAlikeNoisy = [](std::uint32_t) { return 0.1f; };

// Stripes of eight pixels, in noise of twice their height: single pixels do not show what the filter has lost, means
// over 5x5 do. They lose a fifth of the stripes' square themselves, and their noise is another 8 % of it.
TEST(DenoiseMix, GivesBackWhatIsBlurred) {
    const image::Image truth =
        picture(kMixSide, kMixSide, [](auto x, auto, auto) { return x / 8 % 2 == 0 ? 0.45f : 0.55f; });
    Blurred given = blurred(truth, kAlikeNoisy);
    const double before = relMseFrom(given.filtered.picture, truth);
    image::giveBack(given.halves, given.filtered, 1);
    EXPECT_LT(relMseFrom(given.filtered.picture, truth), 0.3 * before);
    for (std::size_t i = 0; i < truth.data.size(); ++i)
        EXPECT_EQ(given.filtered.picture.data[i], 0.5f * (given.filtered.halfA.data[i] + given.filtered.halfB.data[i]));
}

// Where the filter is right, next to nothing of the noise may come back: a share of it that chance explains, whose
// square is a part of the noise of a mean over 5x5. Cells have 41 independent means in each of three channels.
TEST(DenoiseMix, NoiseIsNotGivenBack) {
    const image::Image truth = picture(kMixSide, kMixSide, kGrey);
    Blurred given = blurred(truth, kAlikeNoisy);
    image::giveBack(given.halves, given.filtered, 1);
    const double coarseNoise = 0.1 * 0.1 / 2 / 25 / (0.5 * 0.5 + image::kRelativeFloor);
    EXPECT_LT(relMseFrom(given.filtered.picture, truth), 0.05 * coarseNoise);
}

// Of half of the columns, which are in cells with the others: squared errors, in the mean.
double errorOf(const image::Image& image, const image::Image& truth, bool quiet) {
    double sum = 0;
    std::size_t count = 0;
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            if ((x / 16 % 2 == 0) != quiet || x % 16 < 2 || x % 16 > 13) continue; // no means of both
            for (std::size_t c = 0; c < 3; ++c, ++count)
                sum += std::pow(image.pixel(x, y)[c] - truth.pixel(x, y)[c], 2);
        }
    return sum / static_cast<double>(count);
}

// In each cell quiet stripes, which the filter has lost, and noise of grey, of which it has made what is true: the
// stripes come back, as much as they do alone, and the noise does not.
TEST(DenoiseMix, QuietPixelsAreNotAnsweredForByNoisyOnes) {
    const image::Image truth = picture(kMixSide, kMixSide, [](auto x, auto y, auto) {
        return x / 16 % 2 == 1 ? 0.5f : y / 8 % 2 == 0 ? 0.45f : 0.55f;
    });
    Blurred given = blurred(truth, [](std::uint32_t x) { return x / 16 % 2 == 0 ? 0.002f : 0.1f; });
    const double before = errorOf(given.filtered.picture, truth, true);
    image::giveBack(given.halves, given.filtered, 1);
    EXPECT_LT(errorOf(given.filtered.picture, truth, true), 0.3 * before);
    EXPECT_LT(errorOf(given.filtered.picture, truth, false), 0.1 * 0.1 * 0.1 / 2 / 25);
}

// From one level to the next noise is twice as much, and between two a pixel counts for both.
TEST(DenoiseMix, LevelsAreOfTwiceTheNoise) {
    const float lowest = shared::denoiseNoiseLevel(0);
    EXPECT_EQ(lowest, 0);
    float variance = 1e-6f;
    for (int level = 0; level < shared::kDenoiseNoiseLevels; ++level, variance *= 4)
        EXPECT_NEAR(shared::denoiseNoiseLevel(variance), level, 1e-4f);
    EXPECT_EQ(shared::denoiseNoiseLevel(1e30f), shared::kDenoiseNoiseLevels - 1);
    for (const float at : {0.0f, 0.25f, 3.5f, 6.9f, 7.0f}) {
        float parts = 0;
        for (int level = 0; level < shared::kDenoiseNoiseLevels; ++level)
            parts += shared::denoisePartOfLevel(at, level);
        EXPECT_NEAR(parts, 1, 1e-6f);
    }
}

// Values of one half's bright sample and the other half's ordinary one, which finds no pixel like it and stays as it
// is. Nothing of the bright one may come back.
TEST(DenoiseMix, NoiseOfOneHalfIsNoErrorOfTheFilter) {
    const shared::DenoisedValue bright{0.15f, 15.7f, 0.006f, 0}, other{0.048f, 0.048f, 0.91f, 0};
    const shared::DenoisedValue values[2] = {bright, other};
    for (const int first : {0, 1}) {
        const shared::DenoisedValue &a = values[first], &b = values[1 - first];
        EXPECT_GT(shared::denoiseMixShare(shared::denoiseMix(a, b, shared::denoiseError(a, b, 0))), 0.95f);
    }
}

// A flat picture with few bright samples, which are most of the sums of a cell: they are filtered with the mix as they
// are without, by fewer samples and less noisy guides.
TEST(DenoiseMix, BrightSamplesDoNotComeBack) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> chance(0, 1);
    const image::Image truth = picture(kMixSide, kMixSide, [](auto, auto, auto) { return 0.2f; });
    image::DenoiseInput input;
    for (image::Image* half : {&input.halfA, &input.halfB})
        *half = picture(kMixSide, kMixSide, [&](auto, auto, auto) { return chance(random) < 0.002f ? 50.1f : 0.1f; });
    input.samplesOfHalf = shared::kDenoiseMixSamples - 1;
    const double withoutMix = relMseFrom(image::denoise(input, 1).picture, truth);
    input.samplesOfHalf = shared::kDenoiseMixSamples;
    EXPECT_LT(relMseFrom(image::denoise(input, 1).picture, truth), 1.15 * withoutMix);
}

} // namespace
} // namespace rt::test
