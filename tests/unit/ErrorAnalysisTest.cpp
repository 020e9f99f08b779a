#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Image/ErrorAnalysis.h"

namespace rt::image {
namespace {

constexpr std::uint32_t kImageSide = 128;
constexpr std::uint32_t kIndependent = 1; // pixels
constexpr float kRadiance = 0.5f;

Image constant(float value) {
    Image image(kImageSide, kImageSide, 3);
    image.data.assign(image.data.size(), value);
    return image;
}

Image noisy(float sigma, std::uint32_t seed, float mean = kRadiance) {
    Image image = constant(mean);
    std::mt19937 random(seed);
    std::normal_distribution<float> normal(0, sigma);
    for (float& value : image.data) value += normal(random);
    return image;
}

// A tenth of the difference's variance is the reference's own; what is reported is the image's.
TEST(ErrorAnalysis, TheReferencesVarianceIsSubtracted) {
    const float sigma = 0.06f, own = 0.02f;
    const Reference reference{noisy(own, 1), constant(own * own)};
    const ErrorAnalysis error = analyseError(noisy(sigma, 2), reference, kIndependent);
    const double expected = sigma * sigma;
    const double tolerance = 4 * (expected + own * own) * std::sqrt(2.0 / (kImageSide * kImageSide * 3));
    EXPECT_NEAR(error.mse, expected, tolerance);
    EXPECT_NEAR(error.referenceMse, own * own, 1e-9);
    EXPECT_NEAR(error.rmse, sigma, 0.01 * sigma);
    EXPECT_NEAR(error.relmse, expected / (kRadiance * kRadiance + 0.01), 0.05 * expected / 0.26);
    EXPECT_LT(std::abs(error.biasZ), 4);
    EXPECT_EQ(error.fireflies, 0u);
    EXPECT_EQ(error.fireflyShare, 0);
}

// The spread of the mse over independent images is what mseError says; these have nothing else that varies.
TEST(ErrorAnalysis, TilesTellHowSureTheMseIs) {
    const float sigma = 0.1f;
    const Reference reference{constant(kRadiance), constant(0)};
    const double mseError = analyseError(noisy(sigma, 3), reference, kIndependent).mseError;
    const double expected = sigma * sigma * std::sqrt(2.0 / (kImageSide * kImageSide * 3));
    EXPECT_NEAR(mseError, expected, 4 * expected / std::sqrt(2.0 * kImageSide * kImageSide / 64));
}

// A light in a quarter of the picture, in one channel only, with other noise than the rest.
TEST(ErrorAnalysis, PixelsUpTo1HaveAnErrorOfTheirOwn) {
    const float dim = 0.06f, bright = 0.9f, own = 0.02f;
    Reference reference{noisy(own, 8), constant(own * own)};
    Image image = noisy(dim, 9);
    const Image loud = noisy(bright, 10, 5);
    for (std::uint32_t y = 0; y < kImageSide / 4; ++y)
        for (std::uint32_t x = 0; x < kImageSide; ++x) {
            reference.mean.pixel(x, y)[2] = 5;
            reference.variance.pixel(x, y)[2] = 0.3f;
            image.pixel(x, y)[2] = loud.pixel(x, y)[2];
        }
    const ErrorAnalysis error = analyseError(image, reference, kIndependent);
    EXPECT_DOUBLE_EQ(error.upTo1.share, 0.75);
    const double values = 0.75 * kImageSide * kImageSide * 3,
                 spread = (dim * dim + own * own) * std::sqrt(2.0 / values);
    EXPECT_NEAR(error.upTo1.mse, dim * dim, 4 * spread);
    EXPECT_NEAR(error.upTo1.referenceMse, own * own, 1e-9);
    EXPECT_NEAR(error.upTo1.mseError, spread, 0.3 * spread);
    EXPECT_GT(error.mse, 10 * error.upTo1.mse);
}

TEST(ErrorAnalysis, NoPixelUpTo1HasNoError) {
    const ErrorAnalysis error = analyseError(noisy(0.1f, 11, 2), {constant(2), constant(0)}, kIndependent);
    EXPECT_EQ(error.upTo1.share, 0);
    EXPECT_EQ(error.upTo1.mse, 0);
    EXPECT_GT(error.mse, 0);
    EXPECT_EQ(analyseError(constant(1), {constant(1), constant(0)}, kIndependent).upTo1.share, 1); // 1 is up to 1
}

// A bias of 1.5 % of the noise in each pixel is found: 0.015 sqrt(16384) = 1.9 standard deviations is not yet, 8 % is.
TEST(ErrorAnalysis, BiasOfTheMeanIsFound) {
    const float sigma = 0.1f;
    const Reference reference{constant(kRadiance), constant(0)};
    EXPECT_LT(std::abs(analyseError(noisy(sigma, 4), reference, kIndependent).biasZ), 4);
    EXPECT_GT(analyseError(noisy(sigma, 4, kRadiance + 0.08f * sigma), reference, kIndependent).biasZ, 5);
    EXPECT_LT(analyseError(noisy(sigma, 4, kRadiance - 0.08f * sigma), reference, kIndependent).biasZ, -5);
}

// Noise that four neighbours have in common is four times as much of the mean's variance.
TEST(ErrorAnalysis, PixelsThatShareTheirNoiseAreNotTakenForABias) {
    constexpr std::uint32_t kSeeds = 64, kSide = 2;
    const Reference reference{constant(kRadiance), constant(0)};
    std::uint32_t suspected = 0;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
        const Image noise = noisy(0.1f, seed);
        Image image = noise;
        for (std::uint32_t y = 0; y < kImageSide; ++y)
            for (std::uint32_t x = 0; x < kImageSide; ++x)
                std::copy_n(noise.pixel(x / kSide, y / kSide), 3, image.pixel(x, y));
        EXPECT_LT(std::abs(analyseError(image, reference, kSide).biasZ), 4) << seed;
        if (std::abs(analyseError(image, reference, kIndependent).biasZ) > 4) ++suspected;
    }
    EXPECT_GT(suspected, 0u);
}

TEST(ErrorAnalysis, FirefliesAndTheirShare) {
    const Reference reference{constant(kRadiance), constant(0)};
    Image image = noisy(0.01f, 5);
    image.pixel(7, 9)[1] += 20;
    image.pixel(100, 3)[0] += 20;
    const ErrorAnalysis error = analyseError(image, reference, kIndependent);
    EXPECT_EQ(error.fireflies, 2u);
    const double rest = 1e-4 * kImageSide * kImageSide * 3;
    EXPECT_NEAR(error.fireflyShare, 800 / (800 + rest), 1e-3);
}

TEST(ErrorAnalysis, AnImageThatIsTheReference) {
    const Reference reference{noisy(0.1f, 6), constant(0)};
    const ErrorAnalysis error = analyseError(reference.mean, reference, kIndependent);
    EXPECT_EQ(error.mse, 0);
    EXPECT_EQ(error.flip, 0);
    EXPECT_EQ(error.biasZ, 0);
    EXPECT_TRUE(std::isinf(error.psnr));
    EXPECT_THROW(analyseError(Image(3, 3, 3), reference, kIndependent), InputError);
}

} // namespace
} // namespace rt::image
