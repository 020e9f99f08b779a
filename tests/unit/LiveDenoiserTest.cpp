// The live denoiser against pictures whose truth is known.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <gtest/gtest.h>

#include "Common/Image/Denoise/LiveDenoiser.h"
#include "tests/unit/DenoiseInputs.h"

namespace {

using namespace rt::image;
using namespace rt::test;

class LiveDenoiserTest : public testing::Test {
  protected:
    static constexpr std::uint32_t kSide = 150;
    // The pixels whose value can reach one: those of all levels together.
    static constexpr std::uint32_t kReach = rt::shared::kLiveReach * ((1u << rt::shared::kLiveLevels) - 1);

    static Image filter(const DenoiseInput& input, std::size_t threads = 0) {
        LiveDenoiser denoiser;
        return denoiser.filter(input, threads);
    }
    static void expectSane(const Image& image) {
        for (const float value : image.data) ASSERT_TRUE(std::isfinite(value) && value >= 0);
    }
};

TEST_F(LiveDenoiserTest, KeepsAConstantPicture) {
    const Image constant =
        picture(kSide, kSide, [](auto, auto, auto c) { return 0.3f + 0.2f * static_cast<float>(c); });
    const Image result = filter(equalHalves(constant));
    for (std::size_t i = 0; i < result.data.size(); ++i) ASSERT_NEAR(result.data[i], constant.data[i], 1e-5f);
}

// Where all that can reach a pixel is inside of the image its neighbours are even in number. At the border it leans
// inwards, by less than what counts as no difference.
TEST_F(LiveDenoiserTest, KeepsALinearPicture) {
    const Image ramp = picture(kSide, kSide, [](auto x, auto y, auto c) {
        return 1.0f + 0.004f * static_cast<float>(x) + 0.002f * static_cast<float>(y * (c + 1));
    });
    const Image result = filter(equalHalves(ramp));
    for (std::uint32_t y = 0; y < kSide; ++y)
        for (std::uint32_t x = 0; x < kSide; ++x) {
            const bool isInside = std::min({x, y, kSide - 1 - x, kSide - 1 - y}) >= kReach;
            const float expected = ramp.pixel(x, y)[1];
            ASSERT_NEAR(result.pixel(x, y)[1], expected, (isInside ? 2e-3f : 0.06f) * expected) << x << ", " << y;
        }
}

// Over 20 seeds 1.35 million independent values of standard deviation 0.5 / sqrt(2): z of 4 is a bias of 0.25 %.
TEST_F(LiveDenoiserTest, KeepsTheEnergyOfNoiseAndLowersIt) {
    constexpr int kSeeds = 20;
    double sum = 0, squares = 0;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
        const Image result = filter(noisyHalves(kGrey, 300 + seed, kSide));
        for (const float value : result.data) {
            sum += value;
            squares += (value - 0.5) * (value - 0.5);
        }
    }
    const double values = 3.0 * kSide * kSide * kSeeds;
    EXPECT_LT(std::abs((sum / values - 0.5) / (0.5 / std::sqrt(2 * values))), 4);
    EXPECT_LT(squares / values, 0.125 / 10); // of the variance that the mean of both halves has
}

// What samples are too few to tell: the same noise on both sides, half as bright on one.
TEST_F(LiveDenoiserTest, StopsAtTheEdgesOfAFeature) {
    constexpr std::uint32_t kEdge = 75;
    const auto half = [](auto x, auto, auto) { return x < kEdge ? 0.4f : 0.2f; };
    const auto meanBeside = [](const Image& image, std::uint32_t x) {
        double sum = 0;
        for (std::uint32_t y = 0; y < kSide; ++y) sum += image.pixel(x, y)[0] / kSide;
        return sum;
    };
    DenoiseInput input = noisyHalves(half, 5, kSide);
    input.albedo = picture(kSide, kSide, half);
    const Image result = filter(input);
    const double ratio = meanBeside(result, kEdge - 1) / meanBeside(result, kEdge);
    EXPECT_GT(ratio, 1.6);
    EXPECT_LT(ratio, 2.4);
}

TEST_F(LiveDenoiserTest, KeepsTheEdgeOfALight) {
    constexpr std::uint32_t kEdge = 71;
    expectTheEdgeOfTheLamp(filter(lampBeforeAWall(kSide, kEdge)), kEdge);
}

TEST_F(LiveDenoiserTest, TakesWhateverAPictureMayHold) {
    expectSane(filter(whateverThereMayBe(kSide)));
    expectSane(filter(equalHalves(Image(kSide, kSide))));
}

TEST_F(LiveDenoiserTest, TakesPicturesOfAnySizeOneAfterTheOther) {
    LiveDenoiser denoiser;
    for (const auto& [width, height] :
         {std::pair{1u, 1u}, std::pair{1u, 50u}, std::pair{50u, 1u}, std::pair{65u, 2u}, std::pair{33u, 40u}}) {
        const Image result = denoiser.filter(equalHalves(picture(width, height, kGrey)));
        ASSERT_EQ(result.data.size(), std::size_t{3} * width * height);
        for (const float value : result.data) ASSERT_NEAR(value, 0.5f, 1e-5f);
    }
}

TEST_F(LiveDenoiserTest, HasTheSameBitsForAnyNumberOfThreads) {
    const DenoiseInput input = noisyHalves([](auto x, auto, auto) { return x < 30 ? 0.1f : 1.0f; }, 5, kSide);
    EXPECT_EQ(filter(input, 1).data, filter(input, 5).data);
}

} // namespace
