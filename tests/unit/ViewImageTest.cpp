// Views of something else than the picture: values become colours as the legend says.
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Interactive/ViewImage.h"

namespace rt::app {
namespace {

// A row of 1000 costs: 1, 2, 3 ...
image::Image costs() {
    image::Image image(1000, 1, 1);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<float>(i + 1);
    return image;
}

void expectSameColour(const image::Image& a, std::uint32_t x, const image::Image& b, std::uint32_t y) {
    for (int c = 0; c < 3; ++c) EXPECT_EQ(a.pixel(x, 0)[c], b.pixel(y, 0)[c]) << x << " " << y;
}

TEST(ViewImageTest, LevelsAndValuesOfALegendAreInverse) {
    for (const float unit : {0.0f, 1.0f, 3e-7f}) {
        const Legend legend{Legend::Quantity::Time, 2e-5f, unit};
        EXPECT_EQ(legend.value(0), 0);
        EXPECT_FLOAT_EQ(legend.value(1), 2e-5f);
        for (const float level : {0.1f, 0.5f, 0.9f})
            EXPECT_NEAR(legend.level(legend.value(level)), level, 1e-5f) << unit;
    }
    EXPECT_LT((Legend{Legend::Quantity::Rays, 100, 1}.value(0.5f)), 10); // logarithmic
    EXPECT_EQ((Legend{Legend::Quantity::Error, 100}.value(0.5f)), 50);
    EXPECT_EQ((Legend{Legend::Quantity::Distance}.level(1)), 0); // nothing was hit
}

TEST(ViewImageTest, TheLegendOfCostsTellsTheValueOfTheBrightestColour) {
    const ViewImage rays = showCost(Cost::Rays, costs(), 1), time = showCost(Cost::Time, costs(), 1);
    ASSERT_TRUE(rays.legend && time.legend);
    EXPECT_EQ(rays.legend->quantity, Legend::Quantity::Rays);
    EXPECT_EQ(rays.legend->maximum, 1000);
    EXPECT_EQ(time.legend->quantity, Legend::Quantity::Time);
    EXPECT_EQ(time.legend->maximum, 995); // but for one pixel in 200
    const image::Image brightest = paint({Legend::Quantity::Rays, 1}, {1}, 1, 1);
    expectSameColour(rays.image, 999, brightest, 0);
    expectSameColour(time.image, 994, brightest, 0);
    expectSameColour(time.image, 999, brightest, 0);
    EXPECT_NE(rays.image.pixel(900, 0)[0], brightest.pixel(0, 0)[0]);

    const ViewImage scaled = showCost(Cost::Rays, costs(), 4);
    EXPECT_EQ(scaled.legend->maximum, 250);
    expectSameColour(scaled.image, 249, brightest, 0);
    EXPECT_NE(scaled.image.pixel(200, 0)[0], brightest.pixel(0, 0)[0]);
    EXPECT_TRUE(showCost(Cost::Rays, {}, 1).image.data.empty());
}

TEST(ViewImageTest, ErrorsAreRelativeToTheReference) {
    image::Image picture(2, 1, 3), reference(2, 1, 3);
    reference.data = {0.9f, 0.9f, 0.9f, 0.4f, 0.4f, 0.4f};
    picture.data = {1.4f, 1.4f, 1.4f, 0.4f, 0.4f, 0.4f}; // by a half of 0.9 + 0.1, and not at all
    const ViewImage shown = showError(picture, reference, 0.5);
    ASSERT_TRUE(shown.legend);
    EXPECT_EQ(shown.legend->maximum, 2);
    const image::Image expected = paint(*shown.legend, {shown.legend->value(0.25f), 0}, 2, 1);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(shown.image.data[i], expected.data[i], 1e-6f);
}

TEST(ViewImageTest, NearIsBrightAndNoSurfaceIsBlack) {
    AovImages images;
    images.depth = image::Image(3, 1, 1);
    images.depth.data = {0, 2, 8};
    const ViewImage shown = showFeatures(ViewMode::Depth, images);
    ASSERT_TRUE(shown.legend);
    EXPECT_EQ(shown.legend->quantity, Legend::Quantity::Distance);
    EXPECT_EQ(shown.legend->maximum, 8);
    EXPECT_EQ(shown.image.pixel(0, 0)[0], 0);
    EXPECT_GT(shown.image.pixel(1, 0)[0], shown.image.pixel(2, 0)[0]);
    EXPECT_GT(shown.image.pixel(2, 0)[0], 0);
}

} // namespace
} // namespace rt::app
