// The estimate of relMSE against noise whose relMSE is known in closed form.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Image/ErrorEstimate.h"
#include "Common/Image/Metrics.h"
#include "tests/unit/Statistics.h"

namespace rt::image {
namespace {

constexpr std::uint32_t kSide = 48;
constexpr int kReplicates = 4;

using Noise = std::function<double(std::uint32_t x, std::uint32_t y, std::mt19937& random)>; // one replicate's mean

// Of a picture of four replicates, all channels alike, in which `side` x `side` pixels have the same noise.
RelMseEstimate estimateOf(const Noise& noise, std::uint32_t seed, std::uint32_t width = kSide,
                          std::uint32_t height = kSide, std::uint32_t side = 1) {
    std::mt19937 random(seed);
    Image mean(width, height, 1), variance(width, height, 1);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            if (side > 1) random.seed(seed + 1000 * (y / side * width + x / side));
            test::Mean replicates;
            for (int r = 0; r < kReplicates; ++r) replicates.add(noise(x, y, random));
            *mean.pixel(x, y) = static_cast<float>(replicates.mean());
            *variance.pixel(x, y) = static_cast<float>(replicates.variance() / kReplicates);
        }
    return estimateRelMse(mean, variance, side);
}

// Against the truth, over 40 seeds: the mean within 10 %, the interval around it in 95 % of them.
void expectTruth(const Noise& noise, double truth, std::uint32_t side = 1) {
    constexpr int kSeeds = 40;
    test::Mean mean;
    int within = 0;
    for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
        const RelMseEstimate estimate = estimateOf(noise, seed, kSide, kSide, side);
        mean.add(estimate.value);
        within += estimate.low() <= truth && truth <= estimate.high() ? 1 : 0;
    }
    EXPECT_NEAR(mean.mean() / truth, 1, 0.1);
    EXPECT_GE(within, 35); // fewer: 2 in 1000 where 38 are to be expected
}

TEST(ErrorEstimate, GaussianNoise) {
    for (const double level : {0.03, 0.5, 20.0}) {
        const double sigma = 0.4 * level; // of one replicate
        expectTruth([&](auto, auto, std::mt19937& random) { return std::normal_distribution(level, sigma)(random); },
                    sigma * sigma / kReplicates / (level * level + kRelativeFloor));
    }
}

// What hides in a pixel's own mean: an event in one of 100 replicates that is a hundred times as bright as the rest.
TEST(ErrorEstimate, RareBrightEvents) {
    constexpr double kChance = 0.01, kRadiance = 20, kRest = 0.2, kMean = kRest + kChance * kRadiance;
    expectTruth(
        [&](auto, auto, std::mt19937& random) {
            return kRest + (std::bernoulli_distribution(kChance)(random) ? kRadiance : 0);
        },
        kChance * (1 - kChance) * kRadiance * kRadiance / kReplicates / (kMean * kMean + kRelativeFloor));
}

// As of paths that neighbours share: there are fewer events than pixels have met.
TEST(ErrorEstimate, EventsThatPixelsShare) {
    constexpr double kChance = 0.05, kRadiance = 4, kRest = 0.8, kMean = kRest + kChance * kRadiance;
    expectTruth(
        [&](auto, auto, std::mt19937& random) {
            return kRest + (std::bernoulli_distribution(kChance)(random) ? kRadiance : 0);
        },
        kChance * (1 - kChance) * kRadiance * kRadiance / kReplicates / (kMean * kMean + kRelativeFloor), 2);
}

// Pixels of which a bright light covers a part are unlike both sides: their neighbours say little about them. One
// replicate has 16 samples.
TEST(ErrorEstimate, Edges) {
    constexpr double kLight = 4, kDark = 0.2;
    constexpr int kSamples = 16;
    const auto coverage = [](std::uint32_t x, std::uint32_t y) {
        return std::clamp(x - 20.0 - 0.3 * y, 0.0, 1.0); // of a slanted edge
    };
    double truth = 0;
    for (std::uint32_t y = 0; y < kSide; ++y)
        for (std::uint32_t x = 0; x < kSide; ++x) {
            const double a = coverage(x, y), mean = kDark + a * (kLight - kDark);
            truth += a * (1 - a) * (kLight - kDark) * (kLight - kDark) / kSamples / kReplicates /
                     (mean * mean + kRelativeFloor) / (kSide * kSide);
        }
    expectTruth(
        [&](std::uint32_t x, std::uint32_t y, std::mt19937& random) {
            const int hits = std::binomial_distribution(kSamples, coverage(x, y))(random);
            return kDark + (kLight - kDark) * hits / kSamples;
        },
        truth);
}

TEST(ErrorEstimate, APictureWithoutNoiseHasNoError) {
    const auto picture = [](std::uint32_t x, std::uint32_t y, auto&) { return x * 0.1 + y; };
    EXPECT_EQ(estimateOf(picture, 1).value, 0);
    EXPECT_EQ(estimateOf(picture, 1).high(), 0);
}

TEST(ErrorEstimate, PicturesSmallerThanAWindow) {
    const auto noise = [](auto, auto, std::mt19937& random) { return std::normal_distribution(1.0, 0.2)(random); };
    const double truth = 0.04 / kReplicates / 1.01;
    for (const auto& [width, height] : {std::pair(1u, 1u), std::pair(2u, 1u), std::pair(1u, 3u), std::pair(3u, 2u)}) {
        test::Mean mean;
        for (std::uint32_t seed = 0; seed < 400; ++seed) mean.add(estimateOf(noise, seed, width, height).value);
        EXPECT_NEAR(mean.mean() / truth, 1, 0.2) << width << " x " << height;
    }
}

// A window that forgets a row or a column by subtraction keeps the rounding error of what it forgot.
TEST(ErrorEstimate, AFireflyIsNotSeenFromAfar) {
    const auto with = [](double firefly) {
        return estimateOf(
            [firefly](std::uint32_t x, std::uint32_t y, std::mt19937& random) {
                const double value = std::normal_distribution(1.0, 0.2)(random);
                return x == 3 && y == 3 ? firefly : value;
            },
            5);
    };
    EXPECT_NEAR(with(1e18).value / with(1).value, 1, 0.02);
}

TEST(ErrorEstimate, EveryChannelCounts) {
    Image mean(8, 8), variance(8, 8);
    std::fill(mean.data.begin(), mean.data.end(), 1.0f);
    for (std::size_t i = 1; i < variance.data.size(); i += 3) variance.data[i] = 0.0303f;
    EXPECT_NEAR(estimateRelMse(mean, variance, 1).value, 0.01, 1e-4);
}

} // namespace
} // namespace rt::image
