// A scene that moves, in a window: its time is dragged, played and stepped, and nothing of that is there for others.
#include <cstdint>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/gui/WindowTest.h"
#include "tests/unit/MovingModels.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class MotionTest : public WindowTest {
  protected:
    void startWith(const fs::path& scene) {
        fs::create_directories(folder_ / "config" / "ray-tracing");
        nlohmann::json open; // no panel, so that all their names are seen
        for (const char* panel : {"scene", "rendering"}) open[panel] = false;
        store({{"open_panels", open}, {"saw_first_steps", true}, {"show_comparison", false}});
        start({"--scene", scene.string(), "--width", "64", "--spp", "4"});
    }
    // Where the lamp is seen, from the left: the middle of what is bright in the row at the picture's middle.
    double lampAt() const {
        const Screenshot shot = screenshot();
        double sum = 0, count = 0;
        for (int x = kSide + 20; x < kWidth - 20; ++x) {
            const std::uint32_t pixel = shot.at(x, kRow);
            if ((pixel >> 8 & 0xff) < 0x80) continue;
            sum += x;
            ++count;
        }
        return count > 0 ? sum / count : 0;
    }
    bool isLampRight() const { return lampAt() > kMiddle + 40; }
    bool isLampLeft() const { return lampAt() > 0 && lampAt() < kMiddle - 40; }
    static constexpr int kRow = 500, kMiddle = (kSide + kWidth) / 2;
};
INSTANTIATE_TEST_SUITE_P(, MotionTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, MotionTest, kSecondProgram, nameOfProgram);

TEST_P(MotionTest, TheTimeIsDraggedPlayedAndStepped) {
    startWith(scene::saveMovingLamp(folder_ / "lamp.glb"));
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(appears("0.000 of 1.000 s")) << log();
    EXPECT_TRUE(eventually([this] { return isLampLeft(); }, kSeen)) << lampAt();
    const int row = placesOf("0.000 of 1.000 s").front().y();
    const auto drag = [row, this] {
        act("mousemove 600 " + std::to_string(row) + " sleep 0.3 mousedown 1 sleep 0.2 mousemove 900 " +
            std::to_string(row) + " sleep 0.3 mousemove 1270 " + std::to_string(row) + " sleep 0.2 mouseup 1");
        pointAtNothing();
        for (int i = 0; i < 30 && !isLampRight(); ++i) pause(100);
        return isLampRight();
    };
    EXPECT_TRUE(eventually(drag, kSeen)) << lampAt() << log();
    EXPECT_TRUE(appears("1.000 of 1.000 s")) << log();
    key("comma"); // a frame back, of 24 a second
    EXPECT_TRUE(appears("0.958 of 1.000 s")) << log();
    key("period");
    EXPECT_TRUE(appears("1.000 of 1.000 s")) << log();
    key("k"); // from the start, round and round
    EXPECT_TRUE(eventually([this] { return isLampLeft(); }, kSeen)) << lampAt();
    EXPECT_TRUE(eventually([this] { return isLampRight(); }, kSeen)) << lampAt();
    expectCleanEnd(); // while it plays
}

TEST_P(MotionTest, WhereNothingMovesThereIsNoTime) {
    startWith(writeScene("ball.json", "Ball"));
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(appears("Motion")) << log();
    EXPECT_FALSE(isShown(" of 0.000 s"));
    key("k");
    key("period");
    expectCleanEnd();
}

} // namespace
} // namespace rt::test
