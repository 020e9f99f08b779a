// Swapchains, surfaces, devices, windows and screens that go away while the window is open.
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "Common/Image/ImageIo.h"
#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class WindowLossTest : public WindowTest {
  protected:
    // As FaultLayer.cpp reads them.
    void letFail(const std::string& faults) {
        environment_ = {
            {"VK_ADD_LAYER_PATH", RT_LAYER_DIR}, {"VK_INSTANCE_LAYERS", "VK_LAYER_RT_faults"}, {"RT_FAULTS", faults}};
    }
    // Renders for as long as the window is open, and is to leave an image and statistics behind.
    void startLongRender() {
        start({"--window", "--spp", "1000000", "-o", image_.string(), "--stats", stats_.string()});
    }
    // Until there is something to lose.
    void waitForSamples() {
        EXPECT_TRUE(eventually([&] {
            key("F12"); // saves the image, unless it is too early
            pause(500);
            return !isRunning() || fs::exists(image_);
        })) << log();
        pause(500);
        fs::remove(image_);
    }
    void expectNothingIsLost() const {
        ASSERT_TRUE(fs::exists(image_)) << log();
        EXPECT_EQ(image::readImage(image_).width, 48u);
        std::ifstream in(stats_);
        EXPECT_EQ(nlohmann::json::parse(in, nullptr, false)["stopped_by"], "interrupted");
        EXPECT_EQ(log().find("validation"), std::string::npos) << log();
    }

    fs::path image_, stats_;

  private:
    void SetUp() override {
        WindowTest::SetUp();
        image_ = folder_ / "a.exr";
        stats_ = folder_ / "a.json";
    }
};
INSTANTIATE_TEST_SUITE_P(, WindowLossTest, kBothPrograms, nameOfProgram);

class SharedWindowLossTest : public WindowLossTest {};
INSTANTIATE_TEST_SUITE_P(, SharedWindowLossTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, SharedWindowLossTest, kSecondProgram, nameOfProgram);

constexpr const char* kOutOfDate = "-1000001004";
constexpr const char* kSuboptimal = "1000001003";
constexpr const char* kSurfaceLost = "-1000000000";
constexpr const char* kWindowInUse = "-1000000001";
constexpr const char* kDeviceLost = "-4";
constexpr const char* kTaken = ": the window system has taken the window away\n";

// The last faults show that frames went on behind those before.
TEST_P(SharedWindowLossTest, SwapchainsAndSurfacesAreReplaced) {
    const std::string acquire = "vkAcquireNextImageKHR:", present = "vkQueuePresentKHR:",
                      create = "vkCreateSwapchainKHR:";
    letFail(acquire + "3=" + kOutOfDate + "," + acquire + "6=" + kSurfaceLost + "," + acquire + "9=" + kSuboptimal +
            "," + present + "4=" + kSuboptimal + "," + present + "12=" + kOutOfDate + "," + present +
            "15=" + kSurfaceLost + "," + create + "3=" + kSurfaceLost + "," + create + "5=" + kWindowInUse + "," +
            acquire + "30=" + kSuboptimal + "," + present + "35=" + kSurfaceLost + "," + present + "40=" + kSuboptimal);
    start({"--spp", "1000000"});
    ASSERT_FALSE(HasFatalFailure());
    constexpr std::size_t kFaults = 11;
    const auto happened = [this] {
        const std::string text = log();
        std::size_t count = 0;
        for (std::size_t at = text.find("fault "); at != std::string::npos; at = text.find("fault ", at + 1)) ++count;
        return count;
    };
    EXPECT_TRUE(eventually([&] {
        act("mousemove_relative 1 0 mousemove_relative -- -1 0"); // frames come with input
        return !isRunning() || happened() == kFaults;
    })) << log();
    resize(900, 700);
    key("ctrl+equal");
    EXPECT_TRUE(eventually([&] { return settings()["ui_scale"] == 1.25; })) << log();
    expectCleanEnd();
    EXPECT_EQ(happened(), kFaults);
}

using NightlySwapchainTest = WindowLossTest;
INSTANTIATE_TEST_SUITE_P(, NightlySwapchainTest, kBothPrograms, nameOfProgram);

// Each of the first frames, while the scene is loaded, the film begun and the first pictures are shown.
TEST_P(NightlySwapchainTest, OutOfDateAtFrame) {
    for (int frame = 1; frame <= 12; ++frame) {
        const std::string number = std::to_string(frame);
        for (const std::string call : {"vkAcquireNextImageKHR", "vkQueuePresentKHR"}) {
            letFail(call + ":" + number + "=" + kOutOfDate);
            start({"--spp", "1000000"});
            ASSERT_FALSE(HasFatalFailure());
            EXPECT_TRUE(eventually([&] {
                act("mousemove_relative 1 0 mousemove_relative -- -1 0");
                return !isRunning() || log().find("fault " + call) != std::string::npos;
            })) << log();
            expectCleanEnd();
        }
    }
}

TEST_P(WindowLossTest, ADeviceThatIsLostWhilePresentingEndsItAndNothingIsLost) {
    letFail(std::string("vkQueuePresentKHR:10=") + kDeviceLost);
    startLongRender();
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_EQ(waitForEnd(), 1) << log();
    expectNothingIsLost();
    EXPECT_NE(log().find("Drawing to the window: the device was lost"), std::string::npos) << log();
}

TEST_P(SharedWindowLossTest, AWindowThatIsTakenAwayEndsItAndNothingIsLost) {
    startLongRender();
    ASSERT_FALSE(HasFatalFailure());
    waitForSamples();
    key("ctrl+equal");
    pause(300);
    destroyWindow();
    EXPECT_EQ(waitForEnd(), 1) << log();
    expectNothingIsLost();
    EXPECT_EQ(log(), std::string(GetParam()) + kTaken);
    EXPECT_EQ(settings()["ui_scale"], 1.25);
}

TEST_P(SharedWindowLossTest, AScreenThatIsGoneEndsItAndNothingIsLost) {
    startLongRender();
    ASSERT_FALSE(HasFatalFailure());
    waitForSamples();
    endScreen();
    EXPECT_EQ(waitForEnd(), 1) << log();
    expectNothingIsLost();
    EXPECT_EQ(log(), std::string(GetParam()) + kTaken);
}

} // namespace
} // namespace rt::test
