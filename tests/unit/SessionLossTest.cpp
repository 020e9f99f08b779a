// What is kept where a session is interrupted or something fails.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "Common/Image/Checkpoint.h"
#include "Common/Image/ImageIo.h"
#include "tests/unit/SessionFixture.h"

namespace rt::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using test::bytesOfFile;

class SessionLossTest : public SessionFixture {};

TEST_F(SessionLossTest, InterruptionKeepsWhatThereIs) {
    const auto interruptAt5 = [](std::uint32_t spp) {
        if (spp == 5) std::raise(SIGINT);
    };
    EXPECT_EQ(run({"--spp", "100", "-o", path("a.pfm"), "--stats", path("stats.json")}, interruptAt5),
              ExitCode::Interrupted);
    EXPECT_EQ(statistics()["stopped_by"], "interrupted");
    EXPECT_EQ(statistics()["spp_done"], 5);
    run({"--spp", "5", "-o", path("b.pfm")});
    EXPECT_EQ(bytesOfFile(path("a.pfm")), bytesOfFile(path("b.pfm")));
    const auto terminateAt3 = [](std::uint32_t spp) {
        if (spp == 3) std::raise(SIGTERM);
    };
    EXPECT_EQ(run({"--spp", "100"}, terminateAt3), ExitCode::Interrupted);
}

// As `timeout` sends them, to a program and to its group.
TEST_F(SessionLossTest, TwoInterruptionsAtOnceAreOne) {
    const auto interruptTwice = [](std::uint32_t spp) {
        if (spp != 5) return;
        std::raise(SIGINT);
        std::raise(SIGINT);
    };
    EXPECT_EQ(run({"--spp", "100", "-o", path("a.pfm")}, interruptTwice), ExitCode::Interrupted);
    EXPECT_TRUE(fs::exists(path("a.pfm")));
}

TEST_F(SessionLossTest, SecondInterruptionEndsAtOnce) {
    const auto interruptTwice = [](std::uint32_t) {
        std::raise(SIGINT);
        std::this_thread::sleep_for(std::chrono::milliseconds(250));
        std::raise(SIGINT);
    };
    EXPECT_EXIT(run({"--spp", "100", "-o", path("a.pfm")}, interruptTwice), testing::ExitedWithCode(130), "");
    EXPECT_FALSE(fs::exists(path("a.pfm")));
}

TEST_F(SessionLossTest, PlacesThatCannotBeWrittenAreFoundBeforeRendering) {
    EXPECT_NE(error<RenderError>({"-o", path("missing/a.png")}).find("missing"), std::string::npos);
    EXPECT_NE(error<RenderError>({"--stats", path("missing/s.json")}).find("missing"), std::string::npos);
    EXPECT_NE(error<RenderError>({"--checkpoint", path("missing/c.rtc")}).find("missing"), std::string::npos);
    fs::create_directory(folder_ / "dir.png");
    EXPECT_EQ(error<RenderError>({"-o", path("dir.png")}), path("dir.png") + ": is a directory");
    EXPECT_NE(error<UsageError>({"-o", path("a.gif")}).find("a.gif"), std::string::npos);
    EXPECT_NE(error<UsageError>({"-o", path("png")}).find("png"), std::string::npos);
    EXPECT_EQ(engine_, nullptr);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1); // nothing was left behind
}

TEST_F(SessionLossTest, FilesThatWouldOverwriteOthersAreFoundBeforeRendering) {
    ASSERT_EQ(run({"--spp", "1", "-o", path("old.pfm"), "--checkpoint", path("old.rtc")}), ExitCode::Done);
    std::ofstream(path("scene.json")) << "{}";
    fs::create_directory(folder_ / "sub");
    fs::create_directory_symlink(folder_ / "sub", folder_ / "alias");
    fs::create_symlink("scene.json", path("link.rtc"));
    fs::create_symlink("later.png", path("soon.png")); // to nothing yet
    const std::vector<std::vector<std::string>> wrong = {
        {"--scene", path("scene.json"), "--checkpoint", path("scene.json")},
        {"--scene", path("scene.json"), "--stats", path("sub/../scene.json")},
        {"--scene", path("scene.json"), "--checkpoint", path("link.rtc")},
        {"--reference", path("old.pfm"), "-o", path("old.pfm")},
        {"--resume", path("old.rtc"), "--stats", path("old.rtc")},
        {"-o", path("a.png"), "-o", path("a.png")},
        {"-o", path("sub/a.png"), "-o", path("alias/a.png")},
        {"-o", path("a.png"), "-o", path("a.albedo.png"), "--aov", "albedo"},
        {"-o", path("later.png"), "-o", path("soon.png")},
        {"--checkpoint", path("a"), "--stats", path("a")},
    };
    for (const auto& arguments : wrong) {
        const std::string message = error<UsageError>(arguments);
        EXPECT_NE(message.find("would overwrite"), std::string::npos) << arguments.back() << ": " << message;
        EXPECT_EQ(engine_, nullptr);
    }
    EXPECT_EQ(bytesOfFile(path("scene.json")), "{}");
    EXPECT_EQ(run({"--spp", "2", "--resume", path("old.rtc"), "--checkpoint", path("old.rtc")}), ExitCode::Done);
#ifdef __linux__
    EXPECT_EQ(run({"--spp", "2", "--checkpoint", "/dev/null", "--stats", "/dev/null"}), ExitCode::Done);
#endif
}

TEST_F(SessionLossTest, AFailedOutputLosesNeitherTheOthersNorTheSamples) {
    fs::create_directories(folder_ / "gone");
    fs::create_directories(folder_ / "kept");
    const auto removeFolder = [&](std::uint32_t) { fs::remove_all(folder_ / "gone"); };
    const std::string message = error<RenderError>(
        {"--spp", "9", "-o", path("gone/a.pfm"), "-o", path("kept/b.pfm"), "--stats", path("stats.json")},
        removeFolder);
    const std::string rescued = path("state/ray-tracing/a.pfm.rtc");
    EXPECT_EQ(message.rfind("cannot write " + path("gone/a.pfm") + ": ", 0), 0u) << message;
    EXPECT_NE(message.find(rescued), std::string::npos) << message;
    EXPECT_EQ(statistics()["outputs"], Json::array({path("kept/b.pfm")}));
    run({"--spp", "9", "-o", path("a.pfm"), "--resume", rescued, "--stats", path("stats.json")});
    EXPECT_EQ(bytesOfFile(path("a.pfm")), bytesOfFile(path("kept/b.pfm")));
}

// Neither what lies beside the output, nor an earlier rescue, nor what a link in the place of one leads to.
TEST_F(SessionLossTest, RescuedSamplesOverwriteNothing) {
    fs::create_directories(folder_ / "gone");
    fs::create_directories(folder_ / "state/ray-tracing");
    std::ofstream(path("secret")) << "private";
    fs::create_symlink(path("secret"), path("state/ray-tracing/a.pfm.rtc"));
    const auto removeFolder = [&](std::uint32_t) { fs::remove_all(folder_ / "gone"); };
    for (const char* name : {"a.pfm.2.rtc", "a.pfm.3.rtc"}) {
        fs::create_directories(folder_ / "gone");
        const std::string message = error<RenderError>({"--spp", "2", "-o", path("gone/a.pfm")}, removeFolder);
        EXPECT_NE(message.find(path("state/ray-tracing/") + name), std::string::npos) << message;
    }
    EXPECT_EQ(bytesOfFile(path("secret")), "private");

    fs::create_directories(folder_ / "blocked");
    std::ofstream(path("blocked/a.pfm.rtc")) << "of an earlier render";
    const auto blockOutput = [&](std::uint32_t) { fs::create_directories(path("blocked/a.pfm")); };
    const std::string message = error<RenderError>({"--spp", "2", "-o", path("blocked/a.pfm")}, blockOutput);
    EXPECT_NE(message.find(path("blocked/a.pfm.2.rtc")), std::string::npos) << message;
    EXPECT_EQ(bytesOfFile(path("blocked/a.pfm.rtc")), "of an earlier render");
}

// A checkpoint that was asked for has the samples already.
TEST_F(SessionLossTest, SamplesInACheckpointNeedNoRescue) {
    fs::create_directories(folder_ / "gone");
    const auto removeFolder = [&](std::uint32_t) { fs::remove_all(folder_ / "gone"); };
    const std::string message =
        error<RenderError>({"--spp", "2", "-o", path("gone/a.pfm"), "--checkpoint", path("c.rtc")}, removeFolder);
    EXPECT_EQ(message.find("--resume"), std::string::npos) << message;
    EXPECT_TRUE(fs::exists(path("c.rtc")));
    EXPECT_FALSE(fs::exists(path("state")));
}

// Of whatever kind: want of memory must not lose what there is.
TEST_F(SessionLossTest, ARenderWithoutMemoryIsWritten) {
    const auto fail = [](std::uint32_t sample) {
        if (sample == 3) throw std::bad_alloc();
    };
    EXPECT_THROW(run({"--spp", "9", "-o", path("a.pfm"), "--checkpoint", path("c.rtc")}, fail), std::bad_alloc);
    run({"--spp", "3", "-o", path("b.pfm")});
    EXPECT_EQ(bytesOfFile(path("a.pfm")), bytesOfFile(path("b.pfm")));
    EXPECT_TRUE(fs::exists(path("c.rtc")));
}

// A device that is lost in the middle: what had been rendered is written, the statistics say how far it came.
TEST_F(SessionLossTest, AFailedEngineLosesNothing) {
    const auto fail = [](std::uint32_t sample) {
        if (sample == 5) throw RenderError("the device was lost");
    };
    EXPECT_EQ(error<RenderError>({"--spp", "9", "-o", path("a.pfm"), "--stats", path("stats.json")}, fail),
              "the device was lost");
    EXPECT_EQ(statistics()["stopped_by"], "failure");
    EXPECT_EQ(statistics()["spp_done"], 5);
    run({"--spp", "5", "-o", path("b.pfm")});
    EXPECT_EQ(bytesOfFile(path("a.pfm")), bytesOfFile(path("b.pfm")));
}

TEST_F(SessionLossTest, WhatTheEngineCannotTellLosesNothingElse) {
    const auto failFilm = [this](std::uint32_t sample) { engine_->filmFails = sample == 4; };
    EXPECT_EQ(error<RenderError>({"--spp", "4", "-o", path("a.pfm"), "--stats", path("stats.json")}, failFilm),
              "the film cannot be read");
    EXPECT_EQ(statistics()["spp_done"], 4);
    EXPECT_EQ(image::readImage(path("a.pfm")).width, 20u);

    const auto failAovs = [this](std::uint32_t) { engine_->aovsFail = true; };
    const std::string message = error<RenderError>(
        {"--spp", "4", "-o", path("b.pfm"), "--aov", "albedo", "--stats", path("stats.json")}, failAovs);
    EXPECT_EQ(message.rfind("no features", 0), 0u) << message;
    EXPECT_EQ(bytesOfFile(path("a.pfm")), bytesOfFile(path("b.pfm")));
    EXPECT_EQ(statistics()["outputs"], Json::array({path("b.pfm")}));
}

} // namespace
} // namespace rt::app
