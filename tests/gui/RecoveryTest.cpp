// A window whose program is killed: the next one offers what was not saved.
#include <filesystem>
#include <fstream>
#include <signal.h>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "Common/Image/ImageIo.h"
#include "tests/FileBytes.h"
#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class RecoveryTest : public WindowTest {
  protected:
    static constexpr int kBallX = 826, kBallY = 470; // of the screen: near the picture's middle
    static constexpr Place kSidePlace{0, 0, kSide, kHeight};

    void startWith(const fs::path& scene) {
        nlohmann::json open;
        for (const char* panel : {"scene", "rendering", "camera", "view", "file", "statistics", "settings", "objects"})
            open[panel] = std::string(panel) == "objects";
        fs::create_directories(folder_ / "config" / "ray-tracing");
        store({{"open_panels", open}, {"saw_first_steps", true}, {"show_comparison", false}, {"save_choice", "raw"}});
        start({"--scene", scene.string(), "--width", "64", "--spp", "4"});
    }
    bool selectBall() {
        return clickPlace(kBallX, kBallY, [this] { return isShown("Sphere  /objects/0", kSidePlace); });
    }
    bool isMarkedUnsaved() { return title().find("Ball*") == 0; }
    // The ball gets another material.
    void edit() {
        ASSERT_TRUE(selectBall()) << log();
        ASSERT_TRUE(clickText("Lambertian", kSidePlace, [this] { return isShown("Dielectric"); })) << log();
        ASSERT_TRUE(clickText("Metal", [this] { return isMarkedUnsaved(); })) << log();
    }
    std::vector<fs::path> kept() const {
        std::vector<fs::path> files;
        std::error_code none;
        for (const auto& entry : fs::directory_iterator(folder_ / "state" / "ray-tracing" / "autosave", none))
            if (entry.path().extension() == ".autosave") files.push_back(entry.path());
        return files;
    }
    bool hasKeptEdit() const { return kept().size() == 1 && bytesOfFile(kept()[0]).find("metal") != std::string::npos; }
    // The picture, once it stays as it is: all its samples are there.
    image::Image picture() {
        image::Image last;
        EXPECT_TRUE(eventually([&] {
            image::Image now = savedPicture();
            const bool isSettled = !now.data.empty() && now.data == last.data;
            last = std::move(now);
            return isSettled;
        })) << log();
        return last;
    }
    image::Image savedPicture() {
        const fs::path pictures = folder_ / "pictures";
        fs::remove_all(pictures);
        fs::create_directories(pictures);
        pause(1500);
        key("F12");
        pause(1500);
        for (const auto& entry : fs::directory_iterator(pictures))
            if (entry.path().extension() == ".exr" && entry.path().string().find("denoised") == std::string::npos)
                return image::readImage(entry.path());
        return {};
    }
};
INSTANTIATE_TEST_SUITE_P(, RecoveryTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, RecoveryTest, kSecondProgram, nameOfProgram);

TEST_P(RecoveryTest, WhatWasNotSavedWhenItWasKilledIsHadBack) {
    const fs::path scene = writeScene("ball.json", "Ball");
    startWith(scene);
    ASSERT_FALSE(HasFatalFailure());
    edit();
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(eventually([this] { return hasKeptEdit(); })) << log();
    const image::Image before = picture();
    EXPECT_EQ(endBySignal(SIGKILL), 128 + SIGKILL);
    startWith(scene);
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(appears("Recover")) << log();
    ASSERT_TRUE(clickText("Recover", [this] { return isMarkedUnsaved(); })) << log();
    ASSERT_TRUE(eventually([this] { return !isShown("Later"); }, kSeen)) << log();
    const image::Image after = picture();
    EXPECT_EQ(after.width, before.width);
    EXPECT_TRUE(after.data == before.data) << "another picture than before";
    ASSERT_TRUE(eventually([this] { return hasKeptEdit(); })) << "it would be lost by a second crash";
    ASSERT_TRUE(clickText("Save*", kSidePlace, [this] { return !isMarkedUnsaved(); })) << log();
    EXPECT_TRUE(eventually([this] { return kept().empty(); })) << log();
    EXPECT_NE(bytesOfFile(scene).find("metal"), std::string::npos);
    expectCleanEnd();
}

TEST_P(RecoveryTest, ASignalKeepsEditsAndDiscardingThemDoesNot) {
    const fs::path scene = writeScene("ball.json", "Ball");
    startWith(scene);
    ASSERT_FALSE(HasFatalFailure());
    edit();
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_EQ(endBySignal(SIGTERM), 130) << log();
    EXPECT_TRUE(hasKeptEdit()) << log();
    EXPECT_NE(log().find("are not saved"), std::string::npos) << log();
    startWith(scene);
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(appears("Later")) << log();
    ASSERT_TRUE(clickText("Discard", [this] { return kept().empty(); })) << log();
    EXPECT_FALSE(isMarkedUnsaved());
    edit();
    ASSERT_FALSE(HasFatalFailure());
    key("ctrl+q");
    ASSERT_TRUE(appears("Discard them")) << log();
    ASSERT_TRUE(clickText("Discard them", [this] { return !isRunning(); })) << log();
    EXPECT_TRUE(kept().empty());
}

TEST_P(RecoveryTest, WhatIsDamagedIsToldAndKeptAside) {
    const fs::path place = folder_ / "state" / "ray-tracing" / "autosave";
    fs::create_directories(place);
    std::ofstream(place / "ray-tracing-cpu-1-1.autosave") << "nonsense\n";
    startWith(writeScene("ball.json", "Ball"));
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_TRUE(appears("Dismiss")) << log();
    EXPECT_FALSE(isShown("Recover"));
    EXPECT_EQ(bytesOfFile(place / "ray-tracing-cpu-1-1.damaged"), "nonsense\n");
    expectCleanEnd();
}

// Edits that were discarded for another scene, which could not be opened, are edits all the same.
TEST_P(RecoveryTest, WhatIsNotSavedIsAskedForAgain) {
    startWith(writeScene("ball.json", "Ball"));
    ASSERT_FALSE(HasFatalFailure());
    edit();
    ASSERT_FALSE(HasFatalFailure());
    const fs::path bad = folder_ / "bad.json";
    std::ofstream(bad) << "{";
    const auto isAsked = [&] {
        if (isShown("Discard them")) return true;
        EXPECT_TRUE(drop({bad.string()}));
        return eventually([this] { return isShown("Discard them"); }, kAnswered);
    };
    ASSERT_TRUE(eventually(isAsked, kSeen)) << log();
    ASSERT_TRUE(clickText("Discard them", [this] { return log().find("bad.json") != std::string::npos; })) << log();
    EXPECT_TRUE(isMarkedUnsaved());
    key("ctrl+q");
    EXPECT_TRUE(appears("Discard them")) << log();
    EXPECT_TRUE(isRunning());
}

} // namespace
} // namespace rt::test
