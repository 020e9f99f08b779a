// Why a pixel is noisy: picked in a window, its samples and paths shown, in the panel and over the picture.
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "Common/Probe/PathNames.h"
#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

class NoiseTest : public WindowTest {
  protected:
    static constexpr int kPixelX = 826, kPixelY = 560; // of the screen: the floor, below the picture's middle
    static constexpr Place kPanels{0, 0, kSide, kHeight}, kPicture{kSide, 80, kWidth, kHeight - 40};

    // Of the panels only this one is folded out.
    void startWithPanel() {
        nlohmann::json open;
        for (const char* panel :
             {"scene", "rendering", "camera", "view", "file", "statistics", "settings", "objects", "sampler", "noise"})
            open[panel] = std::string(panel) == "noise";
        std::filesystem::create_directories(folder_ / "config" / "ray-tracing");
        store({{"open_panels", open}, {"saw_first_steps", true}, {"show_comparison", false}});
        start({"--scene", "cornell-box-lights", "--width", "64", "--spp", "16"});
    }
    // Of the picture's part of the screen, in the colour of light sampling, of which no lamp or wall is.
    int pixelsOfLines() const {
        const probe::TechniqueColor line = probe::colorOf(probe::Technique::LightSampling);
        const Screenshot screen = screenshot();
        int count = 0;
        for (int y = kPicture.top; y < kPicture.bottom; ++y)
            for (int x = kPicture.left; x < kPicture.right; ++x) {
                const std::uint32_t color = screen.at(x, y);
                const auto isNear = [color](int shift, int value) {
                    return std::abs(static_cast<int>(color >> shift & 255u) - value) < 6;
                };
                if (isNear(16, line.r) && isNear(8, line.g) && isNear(0, line.b)) ++count;
            }
        return count;
    }
};
INSTANTIATE_TEST_SUITE_P(, NoiseTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, NoiseTest, kSecondProgram, nameOfProgram);

TEST_P(NoiseTest, APixelIsPickedAndItsPathsAreDrawn) {
    startWithPanel();
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(clickText("Pick a pixel", kPanels, [this] { return isShown("Click in the picture", kPanels); }))
        << log();
    const int before = pixelsOfLines();
    click(kPixelX, kPixelY);
    pointAtNothing();
    EXPECT_TRUE(appears("of the variance", kPanels)) << log();
    EXPECT_TRUE(appears("Light sampling", kPanels)) << log();
    EXPECT_TRUE(appears("The brightest paths", kPanels)) << log();
    EXPECT_TRUE(eventually([&] { return pixelsOfLines() > before + 40; }, kSeen)) << before << " " << pixelsOfLines();

    // A bar of the strip, which stands above the table.
    const std::vector<Place> below = placesOf("The brightest paths", kPanels);
    ASSERT_FALSE(below.empty());
    ASSERT_TRUE(eventually(
        [&] {
            click(kSide / 2, below.front().top - 14);
            pointAtNothing();
            return isShown("All paths of sample", kPanels);
        },
        kSeen))
        << log();

    act("mousemove 180 700 sleep 0.2 click --repeat 20 --delay 100 5 sleep 0.5"); // the panel's end
    ASSERT_TRUE(clickText("Draw paths", kPanels, [&] { return pixelsOfLines() <= before; })) << log();
    expectCleanEnd();
}

} // namespace
} // namespace rt::test
