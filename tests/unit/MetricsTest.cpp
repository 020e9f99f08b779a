// Error figures against values worked out by hand.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Image/Metrics.h"

namespace rt::image {
namespace {

Image makeImage(std::uint32_t width, std::uint32_t height, std::vector<float> data) {
    Image image(width, height, static_cast<std::uint32_t>(data.size() / width / height));
    image.data = std::move(data);
    return image;
}

// Luminance of what the heat map shows, weights of Rec. 709.
double lightness(const float* pixel) {
    return 0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2];
}

TEST(Metrics, OfTwoPixels) {
    const Image reference = makeImage(2, 1, {0, 1, 2, 3, 0.5f, 0});
    const Image image = makeImage(2, 1, {0.5f, 1, 2.25f, 2, 0.5f, -1});
    const ErrorFigures figures = compare(image, reference);
    const double mse = (0.25 + 0.0625 + 1 + 1) / 6;
    EXPECT_NEAR(figures.mse, mse, 1e-12);
    EXPECT_NEAR(figures.rmse, std::sqrt(mse), 1e-12);
    EXPECT_NEAR(figures.relmse, (0.25 / 0.01 + 0.0625 / 4.01 + 1 / 9.01 + 1 / 0.01) / 6, 1e-12);
    EXPECT_NEAR(figures.mae, (0.5 + 0.25 + 1 + 1) / 6, 1e-12);
    EXPECT_NEAR(figures.maxAbs, 1, 1e-12);
    // Clamped, only the first value differs: 0.5 is shown as 0.73536 (IEC 61966-2-1).
    EXPECT_NEAR(figures.psnr, 10 * std::log10(6 / (0.735357 * 0.735357)), 1e-4);
}

TEST(Metrics, OfEqualImages) {
    const Image image = makeImage(1, 2, {0.25f, 7});
    const ErrorFigures figures = compare(image, image);
    EXPECT_EQ(figures.mse, 0);
    EXPECT_EQ(figures.relmse, 0);
    EXPECT_EQ(figures.maxAbs, 0);
    EXPECT_EQ(figures.psnr, std::numeric_limits<double>::infinity());
}

TEST(Metrics, DoNotLoseSmallErrorsInLargeImages) {
    // 2^22 values of error 2^-12 each: a sum in float would stop growing at 1.
    Image reference(2048, 2048, 1), image(2048, 2048, 1);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = (reference.data[i] = 1.0f) + 0x1p-12f;
    EXPECT_DOUBLE_EQ(compare(image, reference).mae, 0x1p-12);
    EXPECT_DOUBLE_EQ(compare(image, reference).mse, 0x1p-24);
}

TEST(Metrics, RefuseWhatCannotBeCompared) {
    const Image image(2, 3);
    EXPECT_THROW(compare(image, Image(3, 2)), InputError);
    EXPECT_THROW(compare(image, Image(2, 3, 1)), InputError);
    EXPECT_THROW(heatMap(image, Image(2, 4)), InputError);
    Image bad(2, 3);
    bad.pixel(1, 2)[2] = NAN;
    try {
        compare(image, bad);
        ADD_FAILURE();
    } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find("(1, 2)"), std::string::npos) << e.what();
    }
}

TEST(Metrics, HeatMapGrowsLighterWithTheError) {
    Image reference(100, 1), image(100, 1);
    for (std::uint32_t x = 0; x < 100; ++x) image.pixel(x, 0)[x % 3] = 0.01f * float(x) * (x % 2 == 0 ? 1.0f : -1.0f);
    const Image heat = heatMap(image, reference);
    for (std::uint32_t x = 1; x < 100; ++x)
        EXPECT_GT(lightness(heat.pixel(x, 0)), lightness(heat.pixel(x - 1, 0))) << x;
    EXPECT_LT(lightness(heat.pixel(0, 0)), 0.01);
    EXPECT_GT(lightness(heat.pixel(99, 0)), 0.7);
}

TEST(Metrics, HeatMapIsNotDimmedByAFirefly) {
    Image reference(1000, 1), image(1000, 1);
    for (std::uint32_t x = 0; x < 1000; ++x) image.pixel(x, 0)[0] = x == 500 ? 1e30f : 1.0f;
    EXPECT_GT(lightness(heatMap(image, reference).pixel(0, 0)), 0.7);
    EXPECT_LT(lightness(heatMap(image, image).pixel(0, 0)), 0.01);
}

TEST(Metrics, EstimatesFromVariances) {
    const Image mean = makeImage(2, 1, {1, 0, 2, 0.1f, 3, 0});
    const Image variance = makeImage(2, 1, {0.5f, 0.01f, 0, 0.02f, 1, 0.03f});
    EXPECT_NEAR(referenceRelMse(mean, variance), (0.5 / 1.01 + 1 + 0 + 1 + 1 / 9.01 + 3) / 6, 1e-6);
    EXPECT_NEAR(channelMeans(mean)[1], 1.5, 1e-12);
    // Standard error of the mean of two pixels: sqrt(v1 + v2) / 2.
    EXPECT_NEAR(standardErrors(variance)[0], std::sqrt(0.52) / 2, 1e-7);
    EXPECT_NEAR(channelMeans(makeImage(2, 1, {1, 2}))[2], 1.5, 1e-12);
}

} // namespace
} // namespace rt::image
