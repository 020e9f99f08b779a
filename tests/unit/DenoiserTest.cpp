// The denoiser against pictures whose truth is known.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <random>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "Common/Image/Denoise/Denoiser.h"
#include "Common/Image/Denoise/FilmHalves.h"
#include "Common/Shared/Denoise/DenoiseChoice.h"
#include "tests/unit/DenoiseInputs.h"

namespace {

using namespace rt::image;
using namespace rt::test;

constexpr std::uint32_t kSide = 70; // more than two tiles, and not a multiple of one

void expectNear(const Image& got, const Image& expected, double relative) {
    ASSERT_EQ(got.data.size(), expected.data.size());
    for (std::size_t i = 0; i < got.data.size(); ++i)
        ASSERT_NEAR(got.data[i], expected.data[i], relative * expected.data[i]) << "value " << i;
}

void expectFinite(const Denoised& result) {
    for (const Image* image : {&result.picture, &result.halfA, &result.halfB, &result.error, &result.bandwidth})
        for (const float value : image->data) ASSERT_TRUE(std::isfinite(value) && value >= 0);
    EXPECT_TRUE(std::isfinite(result.relmse.value) && result.relmse.value >= 0);
    EXPECT_TRUE(std::isfinite(result.relmse.standardError));
}

double relMse(const Image& image, double truth) {
    double sum = 0;
    for (const float value : image.data) sum += (value - truth) * (value - truth);
    return sum / static_cast<double>(image.data.size()) / (truth * truth + 0.01);
}

} // namespace

TEST(Denoiser, KeepsAConstantPicture) {
    const Image constant =
        picture(kSide, kSide, [](auto, auto, auto c) { return 0.3f + 0.2f * static_cast<float>(c); });
    expectNear(denoise(equalHalves(constant), 1).picture, constant, 1e-4);
}

TEST(Denoiser, KeepsALinearPicture) {
    const Image ramp = picture(kSide, kSide, [](auto x, auto y, auto c) {
        return 1.0f + 0.004f * static_cast<float>(x) + 0.002f * static_cast<float>(y * (c + 1));
    });
    expectNear(denoise(equalHalves(ramp), 1).picture, ramp, 1e-3);
}

// A texture of squares of 5x5 pixels that a feature knows, under noise: regression on the feature finds it again.
TEST(Denoiser, KeepsWhatIsLinearInAFeature) {
    const auto albedo = [](std::uint32_t x, std::uint32_t y, std::uint32_t) {
        return (x / 5 + y / 5) % 2 == 0 ? 0.2f : 0.8f;
    };
    DenoiseInput input = noisyHalves(albedo, 1, kSide);
    const Image truth = picture(kSide, kSide, albedo);
    const auto error = [&truth](const Image& image) {
        double sum = 0;
        for (std::size_t i = 0; i < truth.data.size(); ++i) {
            const double relative = image.data[i] / truth.data[i] - 1.0;
            sum += relative * relative;
        }
        return sum / static_cast<double>(truth.data.size());
    };
    const double without = error(denoise(input, 1).picture);
    input.albedo = truth;
    const double with = error(denoise(input, 1).picture);
    EXPECT_LT(with, 0.05);          // of 0.5, which the mean of two exponential halves has
    EXPECT_LT(with, 0.5 * without); // which tells the squares by their noise alone
    expectNear(denoise(
                   [&] {
                       DenoiseInput exact = equalHalves(truth);
                       exact.albedo = truth;
                       return exact;
                   }(),
                   1)
                   .picture,
               truth, 0.01);
}

// The mean of a flat field over 40 seeds keeps its energy: with 588 000 independent values of standard deviation
// 0.5 / sqrt(2), z of 4 is a bias of 0.4 %.
TEST(Denoiser, KeepsTheEnergyOfNoiseAndLowersIt) {
    constexpr int kSeeds = 40;
    double sum = 0, gain = 0;
    for (int seed = 0; seed < kSeeds; ++seed) {
        const DenoiseInput input = noisyHalves(kGrey, 100 + static_cast<std::uint32_t>(seed), kSide);
        const Denoised result = denoise(input, 1);
        for (const float value : result.picture.data) sum += value;
        gain += 0.25 / 2 / 0.26 / relMse(result.picture, 0.5) / kSeeds;
    }
    const double values = 3.0 * kSide * kSide * kSeeds;
    const double z = (sum / values - 0.5) / (0.5 / std::sqrt(2 * values));
    EXPECT_LT(std::abs(z), 4);
    EXPECT_GT(gain, 30);
}

// The estimate of one picture is off by the variance of a half over the root of the number of values, and the error is
// that variance over twice the gain: for this size a fourth of it, and a tenth for six pictures.
TEST(Denoiser, KnowsItsError) {
    double estimated = 0, measured = 0;
    for (std::uint32_t seed = 0; seed < 6; ++seed) {
        const Denoised result = denoise(noisyHalves(kGrey, 200 + seed, 200), 1);
        estimated += result.relmse.value;
        measured += relMse(result.picture, 0.5);
    }
    EXPECT_LT(estimated, 1.5 * measured);
    EXPECT_GT(estimated, measured / 1.5);
}

TEST(Denoiser, KeepsTheEdgeOfALight) {
    constexpr std::uint32_t kEdge = 33;
    expectTheEdgeOfTheLamp(denoise(lampBeforeAWall(kSide, kEdge), 1).picture, kEdge);
}

// A texture that no feature knows, nearly free of noise, beside a noisy wall of another direction: up to the edge it
// stays as it is, rather than to be filtered for the wall's sake. Where nothing tells the surfaces apart, it is.
TEST(Denoiser, AQuietSurfaceStaysAsItIsBesideANoisyOne) {
    constexpr std::uint32_t kWall = 40; // its first column
    std::mt19937 random(7);
    std::normal_distribution<float> detail(0, 0.03f), quiet(0, 0.0005f), loud(0, 0.06f);
    const Image truth =
        picture(kSide, kSide, [&](auto x, auto, auto) { return x < kWall ? 0.5f + detail(random) : 0.5f; });
    DenoiseInput input;
    for (Image* half : {&input.halfA, &input.halfB})
        *half = picture(kSide, kSide, [&](auto x, auto y, auto c) {
            return truth.pixel(x, y)[c] + (x < kWall ? quiet(random) : loud(random));
        });
    input.samplesOfHalf = rt::shared::kDenoiseRawSamples;
    const auto errorAtTheEdge = [&](const Image& picture) {
        double sum = 0;
        for (std::uint32_t y = 0; y < kSide; ++y)
            for (std::uint32_t x = kWall - 3; x < kWall - 1; ++x)
                sum += std::pow(picture.pixel(x, y)[0] - truth.pixel(x, y)[0], 2);
        return sum / (2 * kSide);
    };
    const double together = errorAtTheEdge(denoise(input, 1).picture);
    input.normal = picture(kSide, kSide, [](auto x, auto, auto c) { return c == (x < kWall ? 0u : 1u) ? 1.0f : 0.0f; });
    EXPECT_LT(errorAtTheEdge(denoise(input, 1).picture), 0.1 * together);
}

TEST(Denoiser, TakesWhateverAPictureMayHold) {
    expectFinite(denoise(whateverThereMayBe(kSide), 2));
    expectFinite(denoise(equalHalves(Image(kSide, kSide)), 1));
}

TEST(Denoiser, TakesPicturesOfAnySize) {
    for (const auto& [width, height] :
         {std::pair{1u, 1u}, std::pair{1u, 50u}, std::pair{50u, 1u}, std::pair{33u, 2u}}) {
        const Image constant = picture(width, height, kGrey);
        for (const std::uint32_t dependentSide : {1u, 2u}) {
            const Denoised result = denoise(equalHalves(constant), dependentSide);
            expectFinite(result);
            expectNear(result.picture, constant, 1e-4);
        }
    }
}

TEST(Denoiser, NeedsNoneOfTheFeatures) {
    const DenoiseInput noisy = noisyHalves(kGrey, 6, kSide);
    const Image ramp = picture(kSide, kSide, [](auto x, auto, auto) { return static_cast<float>(x) / kSide; });
    Image depth(kSide, kSide, 1);
    for (std::size_t i = 0; i < depth.data.size(); ++i) depth.data[i] = 1 + ramp.data[3 * i];
    const double least = 0.25 / 2 / 0.26 / 20; // a twentieth of the raw picture's
    for (const std::uint32_t lacking : {0u, 1u, 2u, 3u, 4u, 5u, 6u, 7u}) {
        DenoiseInput input = noisy;
        if ((lacking & 1) == 0) input.albedo = ramp;
        if ((lacking & 2) == 0) input.normal = ramp;
        if ((lacking & 4) == 0) input.depth = depth;
        const Denoised result = denoise(input, 1);
        expectFinite(result);
        EXPECT_LT(relMse(result.picture, 0.5), least) << lacking;
    }
}

TEST(Denoiser, HasTheSameBitsForAnyNumberOfThreads) {
    const DenoiseInput input = noisyHalves([](auto x, auto, auto) { return x < 30 ? 0.1f : 1.0f; }, 5, kSide);
    const Denoised one = denoise(input, 2, 1), many = denoise(input, 2, 5);
    EXPECT_EQ(one.picture.data, many.picture.data);
    EXPECT_EQ(one.error.data, many.error.data);
    EXPECT_EQ(one.relmse.value, many.relmse.value);
}

TEST(Denoiser, NeedsBothHalvesOfAFilm) {
    Film film({16, 8, 2});
    Film::TileBlock block;
    const auto add = [&](std::uint32_t tile, std::uint32_t replicate, float value) {
        film.begin(tile, replicate, block);
        block.count = Film::kBlock;
        std::fill(std::begin(block.sum), std::end(block.sum), value * Film::kBlock);
        film.commit(tile, replicate, block);
    };
    EXPECT_NE(whyNoHalves(film).find("no samples"), std::string::npos);
    add(0, 0, 0.25f);
    EXPECT_NE(whyNoHalves(film).find("lacks a part"), std::string::npos);
    add(0, 1, 0.75f);
    EXPECT_EQ(whyNoHalves(film), ""); // of a region, the other tile has none at all
    const DenoiseInput input = filmHalves(film);
    EXPECT_EQ(input.halfA.pixel(3, 3)[1], 0.25f);
    EXPECT_EQ(input.halfB.pixel(3, 3)[1], 0.75f);
    EXPECT_EQ(input.halfA.pixel(9, 3)[1], 0.0f);
    EXPECT_NE(whyNoHalves(Film({8, 8, 1})).find("replicates is 1"), std::string::npos);
}
