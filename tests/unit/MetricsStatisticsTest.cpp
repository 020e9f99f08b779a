// p-values against tables and closed forms; image tests that hold their false alarm rate and find planted errors.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Image/Statistics.h"
#include "tests/image/ImageEquivalence.h"

namespace rt::image {
namespace {

TEST(MetricsStatistics, IncompleteBetaHasItsClosedForms) {
    for (double x = 0.01; x < 1; x += 0.07) {
        EXPECT_NEAR(incompleteBeta(1, 1, x), x, 1e-13);
        EXPECT_NEAR(incompleteBeta(3, 1, x), x * x * x, 1e-13);
        EXPECT_NEAR(incompleteBeta(1, 4, x), 1 - std::pow(1 - x, 4), 1e-13);
        EXPECT_NEAR(incompleteBeta(0.5, 0.5, x), 2 / std::numbers::pi * std::asin(std::sqrt(x)), 1e-13);
        EXPECT_NEAR(incompleteBeta(30.5, 0.5, x) + incompleteBeta(0.5, 30.5, 1 - x), 1, 1e-13);
    }
    EXPECT_EQ(incompleteBeta(2, 3, 0), 0);
    EXPECT_EQ(incompleteBeta(2, 3, 1), 1);
}

TEST(MetricsStatistics, StudentMatchesTables) {
    for (const double t : {0.1, 1.0, 3.0, 40.0}) {
        EXPECT_NEAR(studentTwoSided(t, 1), 1 - 2 / std::numbers::pi * std::atan(t), 1e-12); // Cauchy
        EXPECT_NEAR(studentTwoSided(t, 2), 1 - t / std::sqrt(2 + t * t), 1e-12);
        EXPECT_NEAR(studentTwoSided(-t, 7.5), studentTwoSided(t, 7.5), 1e-15);
        EXPECT_NEAR(studentTwoSided(t, 1e6), std::erfc(t / std::numbers::sqrt2), 1e-6);
    }
    EXPECT_NEAR(studentTwoSided(2.0422725, 30), 0.05, 1e-8); // critical values of the printed tables
    EXPECT_NEAR(studentTwoSided(3.6460, 30), 0.001, 1e-6);
    EXPECT_NEAR(studentTwoSided(4, 62), 1.7e-4, 1e-5);
}

TEST(MetricsStatistics, WelchOfAWorkedExample) {
    const std::vector<double> a = {1, 2, 3, 4, 5}, b = {2, 4, 6, 8, 10, 12};
    const TTest test = welch(estimate(a), estimate(b));
    // Means 3 and 7, variances of the means 2.5/5 = 0.5 and 14/6.
    const double va = 0.5, vb = 14.0 / 6;
    EXPECT_NEAR(test.t, -4 / std::sqrt(va + vb), 1e-12);
    EXPECT_NEAR(test.dof, (va + vb) * (va + vb) / (va * va / 4 + vb * vb / 5), 1e-12);
    EXPECT_NEAR(test.p, studentTwoSided(test.t, test.dof), 1e-15);

    const TTest oneSample = welch(estimate(a), {2.0, 0, 0});
    EXPECT_NEAR(oneSample.t, std::numbers::sqrt2, 1e-12);
    EXPECT_NEAR(oneSample.dof, 4, 1e-12);
}

TEST(MetricsStatistics, ExactMeansAreComparedExactly) {
    EXPECT_EQ(welch({1, 0, 3}, {1 + 5e-6, 0, 0}).p, 1);
    EXPECT_EQ(welch({1, 0, 3}, {1 + 2e-5, 0, 0}).p, 0);
    EXPECT_EQ(welch({0, 0, 3}, {0, 0, 3}).p, 1);
}

TEST(MetricsStatistics, BenjaminiHochbergOfTheirExample) {
    // Benjamini and Hochberg 1995, section 3.2: at q = 0.05 the four smallest of fifteen are rejected.
    const std::vector<double> p = {0.0095, 0.0001, 0.0201, 0.0004, 0.0278, 0.0019, 0.0298, 0.0344,
                                   0.0459, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0000};
    EXPECT_EQ(discoveries(p, 0.05), (std::vector<std::size_t>{0, 1, 3, 5}));
    // A larger p that meets its bound takes along smaller ones that miss theirs.
    EXPECT_EQ(discoveries(std::vector<double>{0.04, 0.045, 0.03, 0.05}, 0.05).size(), 4u);
    EXPECT_TRUE(discoveries(std::vector<double>{}, 0.05).empty());
}

class MetricsImageTest : public testing::Test {
  protected:
    static constexpr std::uint32_t kSide = 64;
    static constexpr std::size_t kBlocks = 32;

    // Block means of `scale` times a picture with noise of 5 %, channels alike in law but independent.
    std::vector<Image> render(float scale = 1, float noise = 0.05f) {
        std::normal_distribution<float> normal(0, noise);
        std::vector<Image> blocks(kBlocks, Image(kSide, kSide));
        for (Image& block : blocks)
            for (std::size_t i = 0; i < block.data.size(); ++i)
                block.data[i] = truth(i) * scale * (1 + normal(random_));
        return blocks;
    }
    static float truth(std::size_t i) { return 0.2f + float(i % 977) / 977; }

    std::mt19937 random_{20};
};

TEST_F(MetricsImageTest, AcceptsEqualImages) {
    for (int trial = 0; trial < 5; ++trial) {
        const ImageTestResult result = testImages(render(), render());
        EXPECT_TRUE(result.passed()) << result.summary();
        EXPECT_EQ(result.pixelP.data.size(), kSide * kSide * 3u);
    }
}

TEST_F(MetricsImageTest, KnowsWhatItCanDetect) {
    const ImageTestResult result = testImages(render(), render());
    // Each channel's mean has standard error 0.05 rms / mean / sqrt(32 * 4096), with rms / mean = 0.7616 / 0.7.
    const double expected = 4 * std::sqrt(2.0) * 0.05 * 1.09 / std::sqrt(32.0 * kSide * kSide);
    EXPECT_NEAR(result.detectableBias / expected, 1,
                0.35); // the worst of three estimates, of 62 degrees of freedom each
    const ImageTestResult biased = testImages(render(1 + float(2 * expected)), render());
    EXPECT_LT(biased.globalP, 1e-6);
    EXPECT_FALSE(biased.passed());
}

TEST_F(MetricsImageTest, FindsOneWrongTileAndOneWrongPixel) {
    std::vector<Image> a = render();
    for (Image& block : a)
        for (std::uint32_t y = 16; y < 24; ++y)
            for (std::uint32_t x = 40; x < 48; ++x) block.pixel(x, y)[1] *= 1.02f;
    ImageTestResult result = testImages(a, render());
    EXPECT_EQ(result.tileDiscoveries, 1u) << result.summary();
    EXPECT_FALSE(result.passed());

    a = render();
    for (Image& block : a) block.pixel(7, 60)[2] *= 1.2f;
    result = testImages(a, render());
    EXPECT_GE(result.pixelDiscoveries, 1u) << result.summary();
    EXPECT_LT(result.pixelP.pixel(7, 60)[2], 1e-8f);
}

TEST_F(MetricsImageTest, FindsCorrelatedPixels) {
    // One noise in both: too alike to be independent.
    const std::vector<Image> a = render();
    std::vector<Image> b = a;
    EXPECT_LT(testImages(a, b).spreadZ, -4);
    // Noise that is common to the blocks of an image: the variance across blocks misses it.
    std::normal_distribution<float> normal(0, 0.02f);
    for (std::size_t i = 0; i < b.front().data.size(); ++i) {
        const float common = 1 + normal(random_);
        for (Image& block : b) block.data[i] *= common;
    }
    EXPECT_GT(testImages(render(), b).spreadZ, 4);
}

TEST_F(MetricsImageTest, ComparesWithAnExactImage) {
    Image exact(kSide, kSide);
    for (std::size_t i = 0; i < exact.data.size(); ++i) exact.data[i] = truth(i);
    EXPECT_TRUE(testImages(render(), {&exact, 1}).passed()) << testImages(render(), {&exact, 1}).summary();
    EXPECT_FALSE(testImages(render(1.001f), {&exact, 1}).passed());

    // Without any noise only rounding is forgiven.
    const std::vector<Image> still(2, exact);
    EXPECT_TRUE(testImages(still, {&exact, 1}).passed());
    std::vector<Image> off = still;
    for (Image& block : off) block.data[100] *= 1.0001f;
    EXPECT_EQ(testImages(off, {&exact, 1}).pixelDiscoveries, 1u);
}

TEST_F(MetricsImageTest, RefusesWhatCannotBeTested) {
    const std::vector<Image> two(2, Image(4, 4)), one(1, Image(4, 4)), other(2, Image(4, 5));
    EXPECT_THROW(testImages(one, two), InputError);
    EXPECT_THROW(testImages(two, {}), InputError);
    EXPECT_THROW(testImages(two, other), InputError);
}

} // namespace
} // namespace rt::image
