// A scene that is edited by way of a window: clicked, changed, undone, saved.
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class EditingTest : public WindowTest {
  protected:
    static constexpr int kBallX = 826, kBallY = 470; // of the screen: near the picture's middle

    // Of the panels only that of the objects is folded out. The scene is one ball in the picture's middle.
    void startWithBall() {
        nlohmann::json open;
        for (const char* panel : {"scene", "rendering", "camera", "view", "file", "statistics", "settings", "objects"})
            open[panel] = std::string(panel) == "objects";
        fs::create_directories(folder_ / "config" / "ray-tracing");
        store({{"open_panels", open}, {"saw_first_steps", true}, {"show_comparison", false}});
        file_ = writeScene("ball.json", "Ball");
        start({"--scene", file_.string(), "--width", "64", "--spp", "4"});
    }
    nlohmann::json saved() const {
        std::ifstream in(file_);
        return nlohmann::json::parse(in, nullptr, false);
    }
    bool isMarkedUnsaved() { return title().find("Ball*") == 0; }
    bool isSelected(const std::string& title) const { return isShown(title, kSidePlace); }
    bool selectBall() {
        return eventually(
            [this] {
                if (isSelected("Sphere  /objects/0")) return true;
                click(kBallX, kBallY);
                pause(1500);
                return isSelected("Sphere  /objects/0");
            },
            kSeen);
    }
    static constexpr Place kSidePlace{0, 0, kSide, kHeight};
    fs::path file_;
};
INSTANTIATE_TEST_SUITE_P(, EditingTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, EditingTest, kSecondProgram, nameOfProgram);

TEST_P(EditingTest, ABallBecomesMetalALightIsAddedAndBothAreSaved) {
    startWithBall();
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(selectBall()) << log();
    ASSERT_TRUE(clickText("Lambertian", kSidePlace, [this] { return isShown("Dielectric"); })) << log();
    ASSERT_TRUE(clickText("Metal", [this] { return !isShown("Dielectric") && isShown("Fuzz", kSidePlace); })) << log();
    EXPECT_TRUE(eventually([this] { return isMarkedUnsaved(); }, kSeen)) << title();
    ASSERT_TRUE(clickText("Add", kSidePlace, [this] { return isShown("Point light"); })) << log();
    ASSERT_TRUE(clickText("Point light", [this] { return isShown("Intensity", kSidePlace); })) << log();
    key("ctrl+z");
    EXPECT_TRUE(eventually([this] { return !isShown("1  Point light", kSidePlace); }, kSeen)) << log();
    key("ctrl+y");
    EXPECT_TRUE(eventually([this] { return isShown("1  Point light", kSidePlace); }, kSeen)) << log();
    ASSERT_TRUE(clickText("Save*", kSidePlace, [this] { return !isMarkedUnsaved(); })) << log();
    ASSERT_TRUE(eventually([this] { return saved().is_object() && saved()["objects"].size() == 2; })) << saved();
    const nlohmann::json scene = saved();
    EXPECT_EQ(scene["objects"][0]["type"], "sphere");
    EXPECT_EQ(scene["objects"][1]["type"], "point_light");
    EXPECT_EQ(scene["materials"]["m"]["type"], "metal");
    expectCleanEnd();
}

// By keys alone from where the ball is selected; whoever closes the window is asked.
TEST_P(EditingTest, AnObjectIsMovedByKeysAndEditsAreNotLostInSilence) {
    startWithBall();
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(selectBall()) << log();
    act("mousemove " + std::to_string(kBallX) + " " + std::to_string(kBallY) + " sleep 0.5");
    key("g");
    act("sleep 0.5 key x sleep 0.5 mousemove_relative 60 30 sleep 0.5 mousemove_relative 40 20 sleep 0.5 click 1");
    EXPECT_TRUE(eventually([this] { return isMarkedUnsaved(); }, kSeen)) << title() << log();
    act("sleep 0.5 key s sleep 0.5 mousemove_relative 60 30 sleep 0.5 key Escape sleep 0.5"); // as if it had not been
    key("ctrl+q");
    ASSERT_TRUE(appears("Save them")) << log();
    const auto isSaved = [this] { return saved().is_object() && saved()["objects"][0]["center"][0] > 0.1; };
    ASSERT_TRUE(clickText("Save them", isSaved)) << log();
    EXPECT_EQ(waitForEnd(), 0) << log();
    const nlohmann::json ball = saved()["objects"][0];
    EXPECT_GT(ball["center"][0], 0.1);
    EXPECT_EQ(ball["center"][1], 0);
    EXPECT_EQ(ball["center"][2], 0);
    EXPECT_EQ(ball["radius"], 1);
}

} // namespace
} // namespace rt::test
