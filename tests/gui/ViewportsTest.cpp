// Two viewports of a window: opened, told apart by their settings and cameras, edited together, closed.
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class ViewportsTest : public WindowTest {
  protected:
    static constexpr int kMiddle = (kSide + kWidth) / 2; // of the picture's part, where two viewports meet
    static constexpr Place kLeft{kSide, 0, kMiddle, kHeight}, kRight{kMiddle, 0, kWidth, kHeight};
    static constexpr int kBallY = 470; // near the middle of both, and on the ball there

    // Of a scene with a dark ball before a bright sky.
    void startWithBall() {
        nlohmann::json open;
        for (const char* panel : {"scene", "camera", "view", "file", "statistics", "settings", "objects"})
            open[panel] = false;
        fs::create_directories(folder_ / "config" / "ray-tracing");
        store({{"open_panels", open}, {"saw_first_steps", true}, {"show_comparison", false}});
        start({"--scene", writeScene("ball.json", "Ball").string(), "--width", "64", "--spp", "4"});
    }
    bool isBallAt(const Place& viewport) const {
        const std::uint32_t color = screenshot().at(viewport.x(), kBallY);
        return (color & 0xff) < 0xd0; // the sky is bluer
    }
    bool bothShowBall(bool isThere) {
        return eventually([&] { return isBallAt(kLeft) == isThere && isBallAt(kRight) == isThere; }, kSeen);
    }
    std::size_t storedViewports() const {
        const nlohmann::json stored = settings();
        return stored.contains("viewports") ? stored["viewports"].size() : 0;
    }
};
INSTANTIATE_TEST_SUITE_P(, ViewportsTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, ViewportsTest, kSecondProgram, nameOfProgram);

TEST_P(ViewportsTest, TwoHaveSettingsAndCamerasOfTheirOwnAndOneScene) {
    startWithBall();
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(appears("4 spp")) << log();
    key("F6");
    ASSERT_TRUE(appears("4 spp", kLeft)) << log();
    ASSERT_TRUE(appears("4 spp", kRight)) << log();
    ASSERT_TRUE(bothShowBall(true));
    EXPECT_TRUE(eventually([this] { return storedViewports() == 2; }, kSeen)) << settings();

    // What is chosen is of the one that was pressed.
    click(kRight.x(), 800);
    pointAtNothing();
    ASSERT_TRUE(clickText("MIS (power heuristic)", {0, 0, kSide, kHeight}, [this] {
        return isShown("Off (BSDF only)");
    })) << log();
    ASSERT_TRUE(clickText("Off (BSDF only)", [this] { return isShown("Off (BSDF only)", kRight); })) << log();
    EXPECT_TRUE(appears("MIS (power heuristic)", kLeft));
    EXPECT_TRUE(appears("4 spp", kRight));

    // An edit reaches both.
    const auto isSelected = [this] { return isShown("Sphere  /objects/0", {0, 0, kSide, kHeight}); };
    ASSERT_TRUE(clickPlace(kLeft.x(), kBallY, isSelected)) << log();
    key("Delete");
    EXPECT_TRUE(bothShowBall(false)) << log();
    key("ctrl+z");
    EXPECT_TRUE(bothShowBall(true)) << log();

    // Cameras follow each other until they are let go.
    const auto lookAside = [this](int x, int by) {
        act("mousemove " + std::to_string(x) + " 700 sleep 0.3 mousedown 3 sleep 0.2 mousemove " +
            std::to_string(x + by) + " 700 sleep 0.3 mouseup 3");
    };
    lookAside(kLeft.x(), 180);
    EXPECT_TRUE(bothShowBall(false)) << log();
    lookAside(kLeft.x(), -180);
    EXPECT_TRUE(bothShowBall(true)) << log();
    key("l");
    lookAside(kRight.x(), 180);
    EXPECT_TRUE(eventually([this] { return !isBallAt(kRight) && isBallAt(kLeft); }, kSeen)) << log();
    EXPECT_TRUE(appears("4 spp", kRight)) << log();

    // The one that has the focus stays.
    key("F6");
    EXPECT_TRUE(eventually([this] { return storedViewports() == 4; }, kSeen)) << settings();
    EXPECT_TRUE(appears("4 spp", {kMiddle, kHeight / 2, kWidth, kHeight})) << log();
    key("F6");
    EXPECT_TRUE(eventually([this] { return settings().contains("viewports") && storedViewports() == 0; }, kSeen));
    EXPECT_TRUE(eventually([this] { return !isShown("MIS (power heuristic)", {kSide, 0, kWidth, kHeight}); }, kSeen));
    EXPECT_EQ(settings()["render"]["light_sampling"], "bsdf");
    expectCleanEnd();
}

} // namespace
} // namespace rt::test
