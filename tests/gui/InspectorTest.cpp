// What the inspector says of a pixel.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Gui/Inspector.h"

namespace rt::gui {
namespace {

std::shared_ptr<const image::Image> uniform(float r, float g, float b) {
    image::Image image(4, 2);
    for (std::size_t i = 0; i < image.data.size(); i += 3)
        image.data[i] = r, image.data[i + 1] = g, image.data[i + 2] = b;
    return std::make_shared<const image::Image>(std::move(image));
}

TEST(Inspector, TellsWhatThePictureHolds) {
    app::Picture picture;
    picture.radiance = picture.subject = uniform(0.5f, 1, 2);
    picture.variance = uniform(0.25f, 0, 0);
    picture.samples = std::make_shared<const image::Image>([] {
        image::Image samples(4, 2, 1);
        std::fill(samples.data.begin(), samples.data.end(), 64.0f);
        return samples;
    }());
    const std::vector<InspectedRow> rows = inspectPixel(picture, nullptr, {3, 1});
    ASSERT_EQ(rows.size(), 4u);
    EXPECT_EQ(rows[0].picture, "3, 1");
    EXPECT_EQ(rows[1].picture, "0.5  1  2");
    EXPECT_EQ(rows[1].held, "");
    EXPECT_EQ(rows[2].picture, "0.25  0  0");
    EXPECT_EQ(rows[3].picture, "64");
    EXPECT_TRUE(inspectPixel(picture, nullptr, {4, 1}).empty());
    EXPECT_TRUE(inspectPixel({}, nullptr, {0, 0}).empty());
}

TEST(Inspector, TellsWhatTheViewShows) {
    app::Picture picture;
    picture.radiance = picture.subject = uniform(0.5f, 1, 2);
    picture.values = uniform(0, 0.6f, 0.8f);
    std::vector<InspectedRow> rows = inspectPixel(picture, nullptr, {0, 0});
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[1].picture, "0  0.6  0.8");
    EXPECT_EQ(rows[2].picture, "0.5  1  2");
    picture.legend = app::Legend{app::Legend::Quantity::Error, 1};
    picture.values = std::make_shared<const image::Image>([] {
        image::Image values(4, 2, 1);
        std::fill(values.data.begin(), values.data.end(), 0.25f);
        return values;
    }());
    rows = inspectPixel(picture, nullptr, {0, 0});
    EXPECT_EQ(rows[1].name, "relative error");
    EXPECT_EQ(rows[1].picture, "0.25");
}

TEST(Inspector, TellsBothValuesAndTheirDifferenceBesideAPinnedPicture) {
    app::Picture picture;
    picture.radiance = picture.subject = uniform(0.5f, 1, 2);
    const std::vector<InspectedRow> rows = inspectPixel(picture, uniform(0.25f, 1, 3).get(), {0, 0});
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0].picture, "B: picture");
    EXPECT_EQ(rows[0].held, "A: pinned");
    EXPECT_EQ(rows[2].picture, "0.5  1  2");
    EXPECT_EQ(rows[2].held, "0.25  1  3");
    EXPECT_EQ(rows[2].difference, "+0.25  +0  -1");
    const image::Image small(1, 1);
    EXPECT_EQ(inspectPixel(picture, &small, {3, 1}).size(), 2u); // nothing to compare with there
}

// A denoised picture beside a pinned one: the radiance, which is not seen, is compared with nothing.
TEST(Inspector, ComparesWhatIsSeenWithWhatIsPinned) {
    app::Picture picture;
    picture.radiance = uniform(8, 8, 8);
    picture.subject = uniform(0.5f, 1, 2);
    picture.isDenoised = true;
    const std::vector<InspectedRow> rows = inspectPixel(picture, uniform(0.25f, 1, 3).get(), {0, 0});
    ASSERT_EQ(rows.size(), 4u);
    EXPECT_EQ(rows[2].name, "denoised");
    EXPECT_EQ(rows[2].difference, "+0.25  +0  -1");
    EXPECT_EQ(rows[3].name, "radiance");
    EXPECT_EQ(rows[3].picture, "8  8  8");
    EXPECT_EQ(rows[3].held + rows[3].difference, "");
}

TEST(Inspector, StandsBelowEachOtherWhereThereIsNoRoomBeside) {
    app::Picture picture;
    picture.radiance = picture.subject = uniform(0.5f, 1, 2);
    picture.variance = uniform(0.25f, 0, 0);
    const auto texts = [](const std::vector<InspectedRow>& rows) {
        std::vector<std::string> lines;
        for (const InspectedRow& row : stacked(rows)) {
            lines.push_back(row.name + " = " + row.picture);
            EXPECT_EQ(row.held + row.difference, "");
        }
        return lines;
    };
    using Lines = std::vector<std::string>;
    EXPECT_EQ(texts(inspectPixel(picture, uniform(0.25f, 1, 3).get(), {3, 1})),
              (Lines{"pixel = 3, 1", "radiance, B: picture = 0.5  1  2", "radiance, A: pinned = 0.25  1  3",
                     "radiance, B - A = +0.25  +0  -1", "variance = 0.25  0  0"}));
    EXPECT_EQ(texts(inspectPixel(picture, nullptr, {3, 1})),
              (Lines{"pixel = 3, 1", "radiance = 0.5  1  2", "variance = 0.25  0  0"}));
    EXPECT_TRUE(stacked({}).empty());
}

} // namespace
} // namespace rt::gui
