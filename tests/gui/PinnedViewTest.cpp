// What is shown of a pinned picture in each view.
#include <memory>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include "Common/Gui/PinnedView.h"

namespace rt::gui {
namespace {

std::shared_ptr<const image::Image> grey(float value) {
    image::Image image(4, 2);
    for (float& number : image.data) number = value;
    return std::make_shared<const image::Image>(std::move(image));
}

app::Picture pictureOf(float value) {
    app::Picture picture;
    picture.image = picture.radiance = picture.subject = grey(value);
    return picture;
}

app::SessionState measuredBy(const std::shared_ptr<const image::Image>& reference) {
    app::SessionState state;
    state.referenceImage = reference;
    state.referenceFits = reference != nullptr;
    return state;
}

app::ViewRequest viewOf(app::ViewMode mode) {
    app::ViewRequest view;
    view.mode = mode;
    return view;
}

TEST(PinnedView, ShowsTheErrorAsThePictureDoes) {
    PinnedView pinned;
    pinned.pin(pictureOf(0.5f), app::ViewMode::Picture, "CPU, 4 spp", std::nullopt);
    pinned.follow(measuredBy(nullptr), viewOf(app::ViewMode::Picture));
    EXPECT_EQ(pinned.shown(), pinned.radiance());
    EXPECT_FALSE(pinned.relmse());
    pinned.follow(measuredBy(grey(0.4f)), viewOf(app::ViewMode::Error));
    EXPECT_NE(pinned.shown(), pinned.radiance());
    EXPECT_TRUE(pinned.isDisplay() && pinned.isSameView());
    ASSERT_TRUE(pinned.relmse());
    EXPECT_NEAR(*pinned.relmse(), 0.1 * 0.1 / (0.4 * 0.4 + 0.01), 1e-6);
    pinned.follow(measuredBy(grey(0.4f)), viewOf(app::ViewMode::Picture));
    EXPECT_EQ(pinned.shown(), pinned.radiance());
}

// Pinned while its error is shown, it is the denoised picture whose error that is.
TEST(PinnedView, IsThePictureThatTheErrorWasOf) {
    app::Picture picture = pictureOf(0.9f);
    picture.subject = grey(0.5f);
    picture.image = grey(1);
    picture.isDisplay = picture.isDenoised = true;
    PinnedView pinned;
    pinned.pin(picture, app::ViewMode::Error, "CPU, 4 spp, denoised", std::nullopt);
    pinned.follow(measuredBy(grey(0.4f)), viewOf(app::ViewMode::Picture));
    EXPECT_EQ(pinned.shown(), picture.subject);
    ASSERT_TRUE(pinned.relmse());
    EXPECT_NEAR(*pinned.relmse(), 0.1 * 0.1 / (0.4 * 0.4 + 0.01), 1e-6);
}

// A reference of another size measures nothing, and of a view that was not kept there is the picture.
TEST(PinnedView, SaysWhereItShowsAnotherView) {
    PinnedView pinned;
    pinned.pin(pictureOf(0.5f), app::ViewMode::Picture, "CPU, 4 spp", std::nullopt);
    pinned.follow(measuredBy(std::make_shared<const image::Image>(1, 1)), viewOf(app::ViewMode::Error));
    EXPECT_FALSE(pinned.isSameView());
    EXPECT_FALSE(pinned.relmse());
    pinned.follow(measuredBy(nullptr), viewOf(app::ViewMode::Noise));
    EXPECT_FALSE(pinned.isSameView());
    EXPECT_EQ(pinned.shown(), pinned.radiance());
}

} // namespace
} // namespace rt::gui
