// What becomes of the window itself: its size, its place on the screen, its end.
#include <csignal>
#include <filesystem>
#include <fstream>

#include "Common/Image/ImageIo.h"
#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

class WindowStateTest : public WindowTest {};
INSTANTIATE_TEST_SUITE_P(, WindowStateTest, kBothPrograms, nameOfProgram);

class SharedWindowStateTest : public WindowTest {};
INSTANTIATE_TEST_SUITE_P(, SharedWindowStateTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, SharedWindowStateTest, kSecondProgram, nameOfProgram);

TEST_P(WindowStateTest, SurvivesEverySize) {
    start({"--no-config"});
    ASSERT_FALSE(HasFatalFailure());
    for (const auto& [width, height] :
         {std::pair{1, 1}, {2, 700}, {1200, 3}, {40, 40}, {1279, 899}, {300, 200}, {1, 1}}) {
        resize(width, height);
        pause(150);
        ASSERT_TRUE(isRunning()) << width << "x" << height << "\n" << log();
    }
    resize(1000, 700);
    for (int i = 0; i < 2; ++i) {
        key("F11");
        pause(300);
    }
    expectCleanEnd();
    EXPECT_FALSE(std::filesystem::exists(folder_ / "config")); // no settings, no layout, no run
}

// All is twice as large: the first header is where the second one would be otherwise.
TEST_P(SharedWindowStateTest, SizesFollowTheMonitor) {
    constexpr int kFirstHeader = 2 * 131;
    setDotsPerInch(192);
    start();
    ASSERT_FALSE(HasFatalFailure());
    act("mousemove 200 " + std::to_string(kFirstHeader) + " click 1");
    EXPECT_TRUE(eventually([&] { return settings()["open_panels"]["scene"] == false; })) << settings();
    EXPECT_EQ(settings()["open_panels"]["rendering"], true);
    EXPECT_EQ(settings()["window_height"], kHeight); // more does not fit
    expectCleanEnd();
}

TEST_P(SharedWindowStateTest, MinimisedItRendersOnAndComesBack) {
    const std::filesystem::path image = folder_ / "a.exr";
    start({"--width", "64", "--spp", "200", "--window", "-o", image.string()});
    ASSERT_FALSE(HasFatalFailure());
    for (int i = 0; i < 2; ++i) {
        minimise(true);
        pause(300);
        minimise(false);
        pause(300);
        ASSERT_TRUE(isRunning()) << log();
    }
    minimise(true);
    key("ctrl+r"); // goes nowhere: nobody sees the window
    EXPECT_TRUE(eventually([&] { return !isRunning() || std::filesystem::exists(image); }));
    ASSERT_TRUE(isRunning()) << log();
    minimise(false);
    resize(1100, 700);
    pause(300);
    expectCleanEnd();
}

TEST_P(SharedWindowStateTest, FilesAreWrittenWhenTheRenderEnds) {
    const std::filesystem::path image = folder_ / "a.png", stats = folder_ / "a.json";
    start({"--window", "-o", image.string(), "--aov", "depth", "--stats", stats.string()});
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_TRUE(eventually([&] { return !isRunning() || std::filesystem::exists(stats); })) << log();
    expectCleanEnd();
    std::ifstream in(stats);
    const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
    EXPECT_EQ(json["app"], GetParam());
    EXPECT_EQ(json["stopped_by"], "spp");
    EXPECT_EQ(json["spp_done"], 4);
    EXPECT_EQ(json["outputs"].size(), 2u);
    EXPECT_TRUE(json["window"].contains("longest_turn_seconds"));
    const nlohmann::json dispatch = json["window"]["longest_dispatch_seconds"];
    EXPECT_EQ(dispatch.is_number() && dispatch > 0, json["app"] == "ray-tracing-gpu") << dispatch;
    EXPECT_EQ(image::readImage(image).width, 48u);
    EXPECT_EQ(image::readImage(folder_ / "a.depth.png").width, 48u);
}

TEST_P(WindowStateTest, ASignalClosesItAndNothingIsLost) {
    const std::filesystem::path image = folder_ / "a.exr";
    start({"--window", "--spp", "1000000", "-o", image.string()});
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_FALSE(std::filesystem::exists(image));
    key("ctrl+equal");
    EXPECT_TRUE(eventually([&] { return settings()["ui_scale"] == 1.25; }));
    EXPECT_EQ(endBySignal(SIGTERM), 130) << log();
    EXPECT_EQ(image::readImage(image).width, 48u);
    EXPECT_EQ(settings()["ui_scale"], 1.25);
}

// The window is seen before there is a device to draw it and an engine.
TEST_P(WindowStateTest, ASignalWhileItOpensEndsIt) {
    launch(GetParam(), {"--window"});
    ASSERT_TRUE(eventually([&] { return !isRunning() || isVisible(); }));
    EXPECT_EQ(endBySignal(SIGTERM), 130) << log();
}

// There is nothing to fall back to that the user has asked for.
TEST_P(SharedWindowStateTest, ASceneThatThereIsNoneOfIsToldOnce) {
    launch(GetParam(), {"--scene", "cornel"});
    EXPECT_EQ(waitForEnd(), 3);
    const std::string text = log(), wanted = "no such scene";
    const std::size_t first = text.find(wanted);
    ASSERT_NE(first, std::string::npos) << text;
    EXPECT_EQ(text.find(wanted, first + 1), std::string::npos) << text;
}

TEST_P(SharedWindowStateTest, ASceneThatIsGoneSinceTheLastTimeIsNoReasonNotToOpen) {
    const std::filesystem::path scene = writeScene("gone.json", "Gone soon");
    start({"--scene", scene.string()});
    ASSERT_FALSE(HasFatalFailure());
    expectCleanEnd();
    std::filesystem::remove(scene);
    start();
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_EQ(title().find("Cornell Box Lights"), 0u) << title();
    EXPECT_NE(log().find("gone.json"), std::string::npos) << log();
    expectCleanEnd();
}

} // namespace
} // namespace rt::test
