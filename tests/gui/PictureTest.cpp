// What there is to see in the picture's part of both windows.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "Common/Image/ImageIo.h"
#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kBorder = 0x2b2b2b; // of the dark theme

int channel(std::uint32_t color, int index) {
    return static_cast<int>(color >> (16 - 8 * index) & 0xff);
}

bool isNear(std::uint32_t color, std::uint32_t wanted, int tolerance) {
    for (int i = 0; i < 3; ++i)
        if (std::abs(channel(color, i) - channel(wanted, i)) > tolerance) return false;
    return true;
}

class PictureTest : public WindowTest {
  protected:
    void closeFirstSteps() const { // the hint of the first run
        fs::create_directories(folder_ / "config" / "ray-tracing");
        store({{"saw_first_steps", true}});
    }

    // Toggles something until the condition holds. It is waited for longer every time: where frames are slow, what
    // toggles again would undo what is about to be seen.
    static bool eventuallyToggled(const std::function<void()>& toggle, const std::function<bool()>& condition) {
        std::chrono::seconds patience(1);
        return eventually([&] {
            toggle();
            patience *= 2;
            return eventually(condition, patience);
        });
    }
};
INSTANTIATE_TEST_SUITE_P(, PictureTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, PictureTest, kSecondProgram, nameOfProgram);

// By a software driver, which these tests have.
TEST_P(PictureTest, FramesThatChangeNothingAreNotDrawnUnlessTheWindowIsExposed) {
    constexpr std::uint32_t kPaint = 0xff00ff;
    closeFirstSteps();
    start();
    ASSERT_FALSE(HasFatalFailure());
    pointAtNothing();
    const auto isPainted = [this] { return screenshot().at(20, 20) == kPaint; };
    EXPECT_TRUE(eventually([&] { // when the render has ended
        paintOver(50, kPaint);
        pause(4000); // a window at rest looks for something new every 1.2 s
        return isPainted();
    }));
    expose();
    EXPECT_TRUE(eventually([&] { return !isPainted(); }));
    EXPECT_TRUE(eventually([&] {
        paintOver(50, kPaint);
        pause(1000);
        return isPainted();
    }));
    key("F3"); // something else is shown
    EXPECT_TRUE(eventually([&] { return !isPainted(); }));
    expectCleanEnd();
}

// Over a corner of it: what is compared by switching views stays in place.
TEST_P(PictureTest, TheLegendLeavesThePictureAsLargeAsItIs) {
    closeFirstSteps();
    start();
    ASSERT_FALSE(HasFatalFailure());
    const auto isBorder = [this](int y) {
        const Screenshot shot = screenshot();
        for (int x = 380; x < kWidth - 10; ++x)
            if (shot.at(x, y) != kBorder) return false;
        return true;
    };
    EXPECT_TRUE(eventually([&] { return screenshot().at(826, 400) != kBorder && isBorder(829); }));
    EXPECT_FALSE(isBorder(815)); // the picture reaches as far down as it can
    EXPECT_TRUE(eventuallyToggled(
        [&] {
            click(652, 16); // Heat map
            act("mousemove 375 40");
        },
        [&] { return isNear(screenshot().at(1050, 800), kWindowColor, 24); })); // through which the picture shines
    EXPECT_TRUE(isBorder(829));
    EXPECT_NE(screenshot().at(826, 815), kBorder);
    expectCleanEnd();
}

// By a label of each at its side of the line between them, wherever that is.
TEST_P(PictureTest, BothSidesOfAComparisonAreLabelled) {
    closeFirstSteps();
    start();
    ASSERT_FALSE(HasFatalFailure());
    // Whether the window's colour, through which the picture shines a little, is there in as many rows as a label has.
    const auto isLabel = [this](int x) {
        const Screenshot shot = screenshot();
        int rows = 0, maximum = 0;
        for (int y = 72; y < 130; ++y) {
            rows = isNear(shot.at(x, y), kWindowColor, 20) ? rows + 1 : 0;
            maximum = std::max(maximum, rows);
        }
        return maximum >= 12 && maximum <= 24;
    };
    const auto isSplitAt = [this](int x) {
        const Screenshot shot = screenshot();
        return shot.at(x, 500) == 0xffffff && shot.at(x, 600) == 0xffffff;
    };
    const auto areLabelled = [&](int line) { return isLabel(line - 12) && isLabel(line + 12); };
    // Too early where there is no picture yet.
    EXPECT_TRUE(eventuallyToggled([&] { key("b"); }, [&] { return isSplitAt(826); })) << log();
    EXPECT_TRUE(eventually([&] { return areLabelled(826); }));
    act("mousemove 826 600 sleep 0.3 mousedown 1 sleep 0.3 mousemove 1040 600 sleep 0.5 mouseup 1 mousemove 375 40");
    EXPECT_TRUE(eventually([&] { return isSplitAt(1040); }));
    EXPECT_TRUE(eventually([&] { return areLabelled(1040); }));
    EXPECT_FALSE(isLabel(826 + 12));
    expectCleanEnd();
}

// To the right of red in the image is green, then blue, then black: so it is to the right of whoever looks about.
TEST_P(PictureTest, AnEnvironmentImageRunsToTheRight) {
    image::Image bands(4, 2);
    for (std::uint32_t y = 0; y < 2; ++y)
        for (std::uint32_t x = 0; x < 3; ++x) bands.pixel(x, y)[x] = 1;
    image::writeImage(folder_ / "bands.pfm", bands);
    std::ofstream(folder_ / "inside.json") << R"({"version": 1, "title": "Inside",
        "camera": {"look_from": [0, 0, 0], "look_at": [1, 0, 0], "vertical_fov": 60},
        "background": {"type": "image", "file": "bands.pfm"},
        "materials": {"m": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}},
        "objects": [{"type": "sphere", "center": [0, -50, 0], "radius": 1, "material": "m"}]})";
    closeFirstSteps();
    start({"--scene", (folder_ / "inside.json").string()});
    ASSERT_FALSE(HasFatalFailure());
    const auto bandAt = [this](int x) {
        const std::uint32_t color = screenshot().at(x, 450);
        const int maximum = std::max({channel(color, 0), channel(color, 1), channel(color, 2)});
        if (maximum < 40) return 3;
        for (int i = 0; i < 3; ++i)
            if (channel(color, i) == maximum) return i;
        return -1;
    };
    // The middle of the image is at +x.
    EXPECT_TRUE(eventually([&] { return bandAt(600) == 1 && bandAt(1050) == 2; })) << bandAt(600) << bandAt(1050);
    expectCleanEnd();
}

} // namespace
} // namespace rt::test
