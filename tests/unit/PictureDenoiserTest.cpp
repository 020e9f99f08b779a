// The denoiser of a window's picture, by the processor.
#include <atomic>
#include <cstdint>
#include <memory>

#include <gtest/gtest.h>

#include "Common/Image/Denoise/FilmHalves.h"
#include "Common/Render/PictureDenoiser.h"
#include "tests/unit/FakeEngine.h"

namespace rt::app {
namespace {

class PictureDenoiserTest : public testing::Test {
  protected:
    void begin(std::uint32_t replicates, std::uint32_t samples) {
        RenderSettings settings;
        settings.width = 40;
        settings.height = 28;
        settings.replicates = replicates;
        engine_.reset({}, settings);
        denoiser_ = engine_.makeDenoiser();
        for (std::uint32_t i = 0; i < samples; ++i) engine_.renderSome({});
    }

    FakeEngine engine_;
    std::unique_ptr<PictureDenoiser> denoiser_;
};

TEST_F(PictureDenoiserTest, FinalIsWhatDenoiseWrites) {
    begin(2, 8);
    const auto result = denoiser_->denoise({DenoiseQuality::Final, true}, kGoOn);
    ASSERT_TRUE(result);
    image::DenoiseInput input = image::filmHalves(engine_.film());
    const AovImages features = engine_.renderAovs({{true, true, true}}, kAovSamples);
    input.albedo = features.albedo;
    input.normal = features.normal;
    input.depth = features.depth;
    const image::Denoised expected = image::denoise(input, 1);
    EXPECT_EQ(result->images.picture.data, expected.picture.data);
    EXPECT_EQ(result->images.halfA.data, expected.halfA.data);
    EXPECT_EQ(result->images.error.data, expected.error.data);
    EXPECT_EQ(result->images.relmse.value, expected.relmse.value);
    EXPECT_TRUE(denoiser_->denoise({}, kGoOn)->images.error.data.empty()); // nobody has asked for it
}

TEST_F(PictureDenoiserTest, LiveHasLessNoise) {
    begin(2, 2);
    const auto result = denoiser_->denoise({DenoiseQuality::Live}, kGoOn);
    ASSERT_TRUE(result);
    const image::Image raw = engine_.film().resolve();
    const auto squares = [](const image::Image& image) {
        double sum = 0;
        for (const float value : image.data) sum += (value - 0.5) * (value - 0.5);
        return sum;
    };
    EXPECT_LT(squares(result->images.picture), 0.2 * squares(raw));
    EXPECT_TRUE(denoiser_->denoise({}, kGoOn)); // with features of more samples
}

TEST_F(PictureDenoiserTest, NeedsHalvesInEveryPixel) {
    begin(1, 8);
    EXPECT_FALSE(denoiser_->denoise({}, kGoOn));
    begin(2, 1);
    EXPECT_FALSE(denoiser_->denoise({}, kGoOn));
    begin(2, 2);
    EXPECT_TRUE(denoiser_->denoise({}, kGoOn));
}

TEST_F(PictureDenoiserTest, GivesUpWhenToldTo) {
    begin(2, 2);
    std::atomic<bool> cancel{true};
    EXPECT_FALSE(denoiser_->denoise({}, cancel));
    cancel = false;
    EXPECT_TRUE(denoiser_->denoise({}, cancel));
}

} // namespace
} // namespace rt::app
