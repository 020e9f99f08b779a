// The way from options to files with an engine that costs nothing: outputs, statistics, limits, interruption,
// checkpoints, and what happens when something cannot be written.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "Common/App/Session/Session.h"
#include "Common/Image/Checkpoint.h"
#include "Common/Image/ImageIo.h"
#include "tests/Environment.h"
#include "tests/TempFolder.h"
#include "tests/unit/FakeEngine.h"

namespace rt::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::string bytesOf(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
}

class SessionTest : public testing::Test {
  protected:
    void SetUp() override { test::setVariable("XDG_STATE_HOME", path("state")); }
    void TearDown() override { test::setVariable("XDG_STATE_HOME", ""); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    // Of a 20x12 image.
    static Options options(std::vector<std::string> arguments) {
        const auto common = {"--headless", "--no-config", "-q", "--width", "20", "--height", "12"};
        arguments.insert(arguments.begin(), common.begin(), common.end());
        std::ostringstream out;
        return parseOptions("ray-tracing-cpu", std::move(arguments), out).value();
    }

    // Runs a session; the fake engine stays at hand.
    ExitCode run(std::vector<std::string> arguments, std::function<void(std::uint32_t)> onSample = {}) {
        engine_ = nullptr;
        return runSession(options(std::move(arguments)), [&] {
            auto engine = std::make_unique<FakeEngine>();
            engine->onSample = onSample;
            engine_ = engine.get();
            return engine;
        });
    }
    // Message of the error that a session ends with.
    template <class Expected>
    std::string error(std::vector<std::string> arguments, std::function<void(std::uint32_t)> onSample = {}) {
        try {
            run(std::move(arguments), std::move(onSample));
        } catch (const Expected& error) {
            return error.what();
        }
        return "no such error";
    }
    Json statistics() const { return Json::parse(bytesOf(path("stats.json"))); }

    test::TempFolder folder_;
    FakeEngine* engine_ = nullptr; // whether one was made; gone once run() returns
};

TEST_F(SessionTest, WritesEachFormat) {
    EXPECT_EQ(run({"--spp", "3", "-o", path("a.png"), "-o", path("a.exr"), "-o", path("a.hdr"), "-o", path("a.pfm")}),
              ExitCode::Done);
    const image::Image pfm = image::readImage(path("a.pfm"));
    ASSERT_EQ(pfm.width, 20u);
    ASSERT_EQ(pfm.height, 12u);
    const auto expected = [](std::uint32_t x, std::uint32_t y, std::uint32_t c) {
        float sum = 0;
        for (std::uint32_t s = 0; s < 3; ++s) sum += FakeEngine::value(x, y, c, s, 0);
        return sum / 3;
    };
    for (std::uint32_t y = 0; y < 12; ++y)
        for (std::uint32_t x = 0; x < 20; ++x)
            for (std::uint32_t c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(pfm.pixel(x, y)[c], expected(x, y, c));
    EXPECT_EQ(image::readImage(path("a.exr")).data, pfm.data);
    for (const char* name : {"a.hdr", "a.png"}) {
        const image::Image other = image::readImage(path(name));
        for (std::size_t i = 0; i < pfm.data.size(); ++i) EXPECT_NEAR(other.data[i], pfm.data[i], 0.01f) << name;
    }
}

TEST_F(SessionTest, ExposureAndToneCurveAreForPngOnly) {
    run({"--spp", "2", "-o", path("a.png"), "-o", path("a.pfm")});
    const std::string linear = bytesOf(path("a.pfm"));
    const float before = image::readImage(path("a.png")).data[0];
    run({"--spp", "2", "-o", path("a.png"), "-o", path("a.pfm"), "--exposure", "-1"});
    EXPECT_EQ(bytesOf(path("a.pfm")), linear);
    EXPECT_NEAR(image::readImage(path("a.png")).data[0], before / 2, 0.01f);
    run({"--spp", "2", "-o", path("a.png"), "-o", path("a.pfm"), "--tonemap", "reinhard"});
    EXPECT_EQ(bytesOf(path("a.pfm")), linear);
    EXPECT_LT(image::readImage(path("a.png")).data[0], before);
}

TEST_F(SessionTest, WritesImagesBesideThePicture) {
    const Json stats = [&] {
        run({"--spp", "40", "-o", path("a.pfm"), "-o", path("b.png"), "--aov", "albedo,normal,depth,variance,samples",
             "--stats", path("stats.json")});
        return statistics();
    }();
    EXPECT_EQ(image::readImage(path("a.albedo.pfm")).data[0], 0.25f);
    EXPECT_EQ(image::readImage(path("a.normal.pfm")).data[0], -1.0f);
    EXPECT_EQ(image::readImage(path("a.depth.pfm")).data[0], 8.0f);
    EXPECT_EQ(image::readImage(path("a.samples.pfm")).data[0], 40.0f);
    // Of the mean of 40 uniform numbers, estimated from three blocks; averaged over the pixels.
    const image::Image variance = image::readImage(path("a.variance.pfm"));
    double mean = 0;
    for (const float value : variance.data) mean += value / static_cast<double>(variance.data.size());
    EXPECT_NEAR(mean, 1.0 / 12 / 40, 0.2 / 12 / 40);
    EXPECT_NEAR(image::readImage(path("b.albedo.png")).data[0], 0.25f, 0.01f);
    EXPECT_EQ(image::readImage(path("b.normal.png")).data[0], 0.0f);
    EXPECT_EQ(image::readImage(path("b.depth.png")).data[0], 1.0f);
    EXPECT_EQ(stats["outputs"].size(), 12u);
    for (const Json& file : stats["outputs"]) EXPECT_TRUE(fs::exists(file.get<std::string>())) << file;
}

TEST_F(SessionTest, StatisticsHaveEveryKeyOfTheContract) {
    run({"--spp", "64", "--stats", path("stats.json"), "--replicates", "8"});
    const Json stats = statistics();
    const Json expected = {{"version", 1},
                           {"app", "ray-tracing-cpu"},
                           {"scene", "cornell-box-lights"},
                           {"engine", "multi"},
                           {"device", "none"},
                           {"threads", 1},
                           {"width", 20},
                           {"height", 12},
                           {"spp", 64},
                           {"spp_done", 64},
                           {"max_depth", 50},
                           {"seed", 0},
                           {"stopped_by", "spp"},
                           {"kernel", "fake/none"},
                           {"nonfinite_samples", 0},
                           {"error_is", "replicates"}};
    for (const auto& [key, value] : expected.items()) EXPECT_EQ(stats[key], value) << key;
    for (const char* key : {"light_sampling", "light_selection", "sphere_light", "quad_light", "triangle_light",
                            "sampler", "one_sided_lights", "russian_roulette", "replicates"})
        EXPECT_TRUE(stats["settings"].contains(key)) << key;
    for (const char* key : {"load", "accel_build", "pipeline", "render", "render_device", "write"})
        EXPECT_GE(stats["seconds"].at(key).get<double>(), 0.0) << key;
    EXPECT_EQ(stats["rays"]["camera"], 10);
    EXPECT_EQ(stats["rays"]["scattered"], 20);
    EXPECT_EQ(stats["rays"]["shadow"], 30);
    EXPECT_GT(stats["samples_per_second"], 0.0);
    EXPECT_GT(stats["memory"]["peak_rss_bytes"], 100'000);
    EXPECT_FALSE(stats.contains("error"));
    EXPECT_NE(std::find(stats["features"].begin(), stats["features"].end(), "quads"), stats["features"].end());
    EXPECT_NE(std::find(stats["skipped"].begin(), stats["skipped"].end(), "volumes"), stats["skipped"].end());

    // 64 uniform numbers in each of 240 pixels: mean 1/2, variance of a pixel's mean 1/768.
    const double sigma = std::sqrt(1.0 / 768 / 240);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(stats["mean_radiance"][c].get<double>(), 0.5, 4 * sigma);
        EXPECT_NEAR(stats["standard_error"][c].get<double>(), sigma, 0.2 * sigma);
    }
    const double relmse = stats["estimated_relmse"];
    EXPECT_NEAR(relmse, 1.0 / 768 / 0.26, 0.2 / 768 / 0.26);
    EXPECT_GT(stats["estimated_relmse_interval"][0].get<double>(), 0.7 * relmse);
    EXPECT_LT(stats["estimated_relmse_interval"][0].get<double>(), 0.95 * relmse);
    EXPECT_GT(stats["estimated_relmse_interval"][1].get<double>(), 1.05 * relmse);
}

TEST_F(SessionTest, WhatIsUnknownIsNull) {
    run({"--spp", "16", "--stats", path("stats.json")});
    EXPECT_TRUE(statistics()["standard_error"].is_null());
    EXPECT_TRUE(statistics()["estimated_relmse"].is_null());
    EXPECT_TRUE(statistics()["estimated_relmse_interval"].is_null());
    EXPECT_TRUE(statistics()["error_is"].is_null());
    run({"--spp", "17", "--stats", path("stats.json")});
    EXPECT_GT(statistics()["estimated_relmse"].get<double>(), 0.0);
    EXPECT_EQ(statistics()["error_is"], "blocks");
}

TEST_F(SessionTest, StatisticsGoToStandardOutput) {
    testing::internal::CaptureStdout();
    run({"--spp", "1", "--stats", "-"});
    EXPECT_EQ(Json::parse(testing::internal::GetCapturedStdout())["spp_done"], 1);
}

TEST_F(SessionTest, ReferenceAddsErrorFigures) {
    run({"--spp", "8", "-o", path("reference.exr")});
    run({"--spp", "8", "--reference", path("reference.exr"), "--stats", path("stats.json")});
    EXPECT_EQ(statistics()["error"]["mse"], 0.0);
    EXPECT_TRUE(statistics()["error"]["psnr"].is_null()); // infinite
    run({"--spp", "8", "--seed", "1", "--reference", path("reference.exr"), "--stats", path("stats.json")});
    EXPECT_NEAR(statistics()["error"]["mse"].get<double>(), 2.0 / 12 / 8, 0.2 / 12 / 8);
}

TEST_F(SessionTest, BadReferencesAreFoundBeforeRendering) {
    EXPECT_NE(error<InputError>({"--reference", path("missing.exr")}).find("missing.exr"), std::string::npos);
    image::writeImage(path("small.pfm"), image::Image(3, 4));
    EXPECT_EQ(error<InputError>({"--reference", path("small.pfm")}),
              path("small.pfm") + ": has 3x4 pixels of 3 channels, but the render 20x12 pixels of 3 channels");
    image::writeImage(path("display.png"), image::Image(20, 12));
    EXPECT_EQ(error<InputError>({"--reference", path("display.png")}),
              path("display.png") + ": a reference must be linear: .exr, .hdr or .pfm");
    EXPECT_EQ(engine_, nullptr);
}

TEST_F(SessionTest, TimeLimit) {
    run({"--spp", "2000000000", "--time-limit", "0.05", "--stats", path("stats.json"), "-o", path("a.pfm")});
    EXPECT_EQ(statistics()["stopped_by"], "time_limit");
    EXPECT_GE(statistics()["spp_done"], 1);
    EXPECT_GE(statistics()["seconds"]["render"].get<double>(), 0.0);
    EXPECT_TRUE(fs::exists(path("a.pfm")));
}

TEST_F(SessionTest, TargetError) {
    run({"--spp", "1000000", "--target-error", "0.005", "--stats", path("stats.json")});
    const Json stats = statistics();
    EXPECT_EQ(stats["stopped_by"], "target_error");
    EXPECT_LT(stats["estimated_relmse_interval"][1].get<double>(), 0.005);
    EXPECT_EQ(stats["error_is"], "replicates");
    EXPECT_EQ(stats["settings"]["replicates"], 4);
    // 1/12 / n / (1/4 + 0.01) = 0.005 at n = 64; the interval ends 16 % higher, give or take the 10 % of chance; looks
    // are 10 % apart, and two have to agree.
    EXPECT_GT(stats["spp_done"].get<double>(), 64);
    EXPECT_LT(stats["spp_done"].get<double>(), 64 * 1.16 * 1.1 * 1.1 * 1.1);
}

TEST_F(SessionTest, InterruptionKeepsWhatThereIs) {
    const auto interruptAt5 = [](std::uint32_t spp) {
        if (spp == 5) std::raise(SIGINT);
    };
    EXPECT_EQ(run({"--spp", "100", "-o", path("a.pfm"), "--stats", path("stats.json")}, interruptAt5),
              ExitCode::Interrupted);
    EXPECT_EQ(statistics()["stopped_by"], "interrupted");
    EXPECT_EQ(statistics()["spp_done"], 5);
    run({"--spp", "5", "-o", path("b.pfm")});
    EXPECT_EQ(bytesOf(path("a.pfm")), bytesOf(path("b.pfm")));
    const auto terminateAt3 = [](std::uint32_t spp) {
        if (spp == 3) std::raise(SIGTERM);
    };
    EXPECT_EQ(run({"--spp", "100"}, terminateAt3), ExitCode::Interrupted);
}

// As `timeout` sends them, to a program and to its group.
TEST_F(SessionTest, TwoInterruptionsAtOnceAreOne) {
    const auto interruptTwice = [](std::uint32_t spp) {
        if (spp != 5) return;
        std::raise(SIGINT);
        std::raise(SIGINT);
    };
    EXPECT_EQ(run({"--spp", "100", "-o", path("a.pfm")}, interruptTwice), ExitCode::Interrupted);
    EXPECT_TRUE(fs::exists(path("a.pfm")));
}

TEST_F(SessionTest, SecondInterruptionEndsAtOnce) {
    const auto interruptTwice = [](std::uint32_t) {
        std::raise(SIGINT);
        std::this_thread::sleep_for(std::chrono::milliseconds(250));
        std::raise(SIGINT);
    };
    EXPECT_EXIT(run({"--spp", "100", "-o", path("a.pfm")}, interruptTwice), testing::ExitedWithCode(130), "");
    EXPECT_FALSE(fs::exists(path("a.pfm")));
}

TEST_F(SessionTest, ResumesToTheSameBits) {
    for (const std::string sampler : {"sobol", "sobol-blue", "stratified"})
        for (const std::string replicates : {"1", "3"}) {
            const std::vector<std::string> common = {"--spp", "75", "--sampler", sampler, "--replicates", replicates};
            const auto with = [&common](std::vector<std::string> more) {
                more.insert(more.begin(), common.begin(), common.end());
                return more;
            };
            run(with({"-o", path("whole.pfm")}));
            const auto interruptAt41 = [](std::uint32_t spp) {
                if (spp == 41) std::raise(SIGINT);
            };
            run(with({"--checkpoint", path("c.rtc"), "-o", path("part.pfm")}), interruptAt41);
            EXPECT_NE(bytesOf(path("part.pfm")), bytesOf(path("whole.pfm")));
            run(with({"--resume", path("c.rtc"), "-o", path("part.pfm"), "--stats", path("stats.json")}));
            EXPECT_EQ(bytesOf(path("part.pfm")), bytesOf(path("whole.pfm")));
            EXPECT_EQ(statistics()["spp_done"], 75);
        }
}

TEST_F(SessionTest, ResumesToMoreSamples) {
    run({"--spp", "20", "--checkpoint", path("c.rtc")});
    run({"--spp", "50", "--resume", path("c.rtc"), "-o", path("a.pfm")});
    run({"--spp", "50", "-o", path("b.pfm")});
    EXPECT_EQ(bytesOf(path("a.pfm")), bytesOf(path("b.pfm")));
    EXPECT_EQ(error<InputError>({"--spp", "19", "--resume", path("c.rtc")}),
              path("c.rtc") + ": spp is at 20 in the checkpoint already but 19 now");
}

TEST_F(SessionTest, CheckpointsOfAnotherRenderAreRefused) {
    run({"--spp", "4", "--checkpoint", path("c.rtc")});
    const auto refused = [&](std::vector<std::string> arguments, const std::string& field) {
        arguments.insert(arguments.end(), {"--spp", "8", "--resume", path("c.rtc")});
        const std::string message = error<InputError>(arguments);
        EXPECT_EQ(message.rfind(path("c.rtc") + ": " + field + " is ", 0), 0u) << field << ": " << message;
    };
    refused({"--seed", "1"}, "seed");
    refused({"--sampler", "independent"}, "sampler");
    refused({"--max-depth", "49"}, "max_depth");
    refused({"--light-sampling", "bsdf"}, "light_sampling");
    refused({"--light-selection", "power"}, "light_selection");
    refused({"--sphere-light", "area"}, "sphere_light");
    refused({"--quad-light", "area"}, "quad_light");
    refused({"--triangle-light", "area"}, "triangle_light");
    refused({"--specular-connections", "off"}, "specular_connections");
    refused({"--russian-roulette", "off"}, "russian_roulette");
    refused({"--replicates", "2"}, "replicates");
    refused({"--width", "21"}, "width");
    refused({"--height", "13"}, "height");
    refused({"--one-sided-lights", "off"}, "scene_hash");
    refused({"--scene", "one-weekend-final"}, "camera");
    refused({"--aov", "variance", "-o", path("a.pfm")}, "second_moments");
    run({"--spp", "4", "--sampler", "stratified", "--checkpoint", path("s.rtc")});
    EXPECT_NE(error<InputError>({"--spp", "8", "--sampler", "stratified", "--resume", path("s.rtc")}).find("spp is 4"),
              std::string::npos);
}

// As they were before there were connections.
TEST_F(SessionTest, CheckpointsThatDoNotTellMadeNoConnections) {
    const auto runWithout = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"--specular-connections", "off"});
        run(arguments);
    };
    runWithout({"--spp", "4", "--checkpoint", path("c.rtc")});
    image::Checkpoint checkpoint = image::readCheckpoint(path("c.rtc"));
    ASSERT_EQ(checkpoint.render.erase("specular_connections"), 1u);
    image::writeCheckpoint(path("c.rtc"), checkpoint.render, checkpoint.film);
    EXPECT_EQ(error<InputError>({"--spp", "8", "--resume", path("c.rtc")}),
              path("c.rtc") +
                  R"(: specular_connections is "off" in the checkpoint (of a program that had no choice) )" +
                  R"(but "on" now)");
    runWithout({"--spp", "8", "--resume", path("c.rtc"), "-o", path("a.pfm")});
    runWithout({"--spp", "8", "-o", path("b.pfm")});
    EXPECT_EQ(bytesOf(path("a.pfm")), bytesOf(path("b.pfm")));
}

TEST_F(SessionTest, DamagedCheckpointsAreRefused) {
    run({"--spp", "4", "--checkpoint", path("c.rtc")});
    const std::string whole = bytesOf(path("c.rtc"));
    const auto resumed = [&](const std::string& bytes) {
        std::ofstream(path("bad.rtc"), std::ios::binary) << bytes;
        return error<InputError>({"--spp", "8", "--resume", path("bad.rtc")});
    };
    for (const std::size_t size : {std::size_t{0}, std::size_t{7}, std::size_t{30}, whole.size() / 2, whole.size() - 1})
        EXPECT_EQ(resumed(whole.substr(0, size)).rfind(path("bad.rtc") + ": ", 0), 0u) << size;
    EXPECT_EQ(resumed("P6 1 1 255 ...").rfind(path("bad.rtc") + ": ", 0), 0u);
    EXPECT_NE(error<InputError>({"--resume", path("missing.rtc")}).find("missing.rtc"), std::string::npos);
}

TEST_F(SessionTest, SavesEverySoOften) {
    bool seen = false;
    const auto look = [&](std::uint32_t) { seen = seen || fs::exists(path("a.png.rtc")); };
    run({"--spp", "50", "-o", path("a.png"), "--save-every", "1e-9"}, look);
    EXPECT_TRUE(seen);
    run({"--spp", "60", "-o", path("b.pfm"), "--resume", path("a.png.rtc")});
    EXPECT_FALSE(fs::exists(path("b.pfm.rtc")));
}

TEST_F(SessionTest, PlacesThatCannotBeWrittenAreFoundBeforeRendering) {
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

TEST_F(SessionTest, FilesThatWouldOverwriteOthersAreFoundBeforeRendering) {
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
    EXPECT_EQ(bytesOf(path("scene.json")), "{}");
    EXPECT_EQ(run({"--spp", "2", "--resume", path("old.rtc"), "--checkpoint", path("old.rtc")}), ExitCode::Done);
#ifdef __linux__
    EXPECT_EQ(run({"--spp", "2", "--checkpoint", "/dev/null", "--stats", "/dev/null"}), ExitCode::Done);
#endif
}

TEST_F(SessionTest, AFailedOutputLosesNeitherTheOthersNorTheSamples) {
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
    EXPECT_EQ(bytesOf(path("a.pfm")), bytesOf(path("kept/b.pfm")));
}

// Neither what lies beside the output, nor an earlier rescue, nor what a link in the place of one leads to.
TEST_F(SessionTest, RescuedSamplesOverwriteNothing) {
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
    EXPECT_EQ(bytesOf(path("secret")), "private");

    fs::create_directories(folder_ / "blocked");
    std::ofstream(path("blocked/a.pfm.rtc")) << "of an earlier render";
    const auto blockOutput = [&](std::uint32_t) { fs::create_directories(path("blocked/a.pfm")); };
    const std::string message = error<RenderError>({"--spp", "2", "-o", path("blocked/a.pfm")}, blockOutput);
    EXPECT_NE(message.find(path("blocked/a.pfm.2.rtc")), std::string::npos) << message;
    EXPECT_EQ(bytesOf(path("blocked/a.pfm.rtc")), "of an earlier render");
}

// A checkpoint that was asked for has the samples already.
TEST_F(SessionTest, SamplesInACheckpointNeedNoRescue) {
    fs::create_directories(folder_ / "gone");
    const auto removeFolder = [&](std::uint32_t) { fs::remove_all(folder_ / "gone"); };
    const std::string message =
        error<RenderError>({"--spp", "2", "-o", path("gone/a.pfm"), "--checkpoint", path("c.rtc")}, removeFolder);
    EXPECT_EQ(message.find("--resume"), std::string::npos) << message;
    EXPECT_TRUE(fs::exists(path("c.rtc")));
    EXPECT_FALSE(fs::exists(path("state")));
}

// Of whatever kind: want of memory must not lose what there is.
TEST_F(SessionTest, ARenderWithoutMemoryIsWritten) {
    const auto fail = [](std::uint32_t sample) {
        if (sample == 3) throw std::bad_alloc();
    };
    EXPECT_THROW(run({"--spp", "9", "-o", path("a.pfm"), "--checkpoint", path("c.rtc")}, fail), std::bad_alloc);
    run({"--spp", "3", "-o", path("b.pfm")});
    EXPECT_EQ(bytesOf(path("a.pfm")), bytesOf(path("b.pfm")));
    EXPECT_TRUE(fs::exists(path("c.rtc")));
}

// A device that is lost in the middle: what had been rendered is written, the statistics say how far it came.
TEST_F(SessionTest, AFailedEngineLosesNothing) {
    const auto fail = [](std::uint32_t sample) {
        if (sample == 5) throw RenderError("the device was lost");
    };
    EXPECT_EQ(error<RenderError>({"--spp", "9", "-o", path("a.pfm"), "--stats", path("stats.json")}, fail),
              "the device was lost");
    EXPECT_EQ(statistics()["stopped_by"], "failure");
    EXPECT_EQ(statistics()["spp_done"], 5);
    run({"--spp", "5", "-o", path("b.pfm")});
    EXPECT_EQ(bytesOf(path("a.pfm")), bytesOf(path("b.pfm")));
}

TEST_F(SessionTest, WhatTheEngineCannotTellLosesNothingElse) {
    const auto failFilm = [this](std::uint32_t sample) { engine_->filmFails = sample == 4; };
    EXPECT_EQ(error<RenderError>({"--spp", "4", "-o", path("a.pfm"), "--stats", path("stats.json")}, failFilm),
              "the film cannot be read");
    EXPECT_EQ(statistics()["spp_done"], 4);
    EXPECT_EQ(image::readImage(path("a.pfm")).width, 20u);

    const auto failAovs = [this](std::uint32_t) { engine_->aovsFail = true; };
    const std::string message = error<RenderError>(
        {"--spp", "4", "-o", path("b.pfm"), "--aov", "albedo", "--stats", path("stats.json")}, failAovs);
    EXPECT_EQ(message.rfind("no features", 0), 0u) << message;
    EXPECT_EQ(bytesOf(path("a.pfm")), bytesOf(path("b.pfm")));
    EXPECT_EQ(statistics()["outputs"], Json::array({path("b.pfm")}));
}

TEST_F(SessionTest, ForcedFeaturesMustCoverTheScene) {
    const std::string message = error<UsageError>({"--features", "spheres,lambertian"});
    EXPECT_EQ(message.rfind("--features: the scene also needs quads,", 0), 0u) << message;
    EXPECT_EQ(run({"--features", "all", "--spp", "1"}), ExitCode::Done);
}

TEST_F(SessionTest, UnknownScenes) {
    EXPECT_NE(error<InputError>({"--scene", "cornell-box"}).find("cornell-box"), std::string::npos);
    EXPECT_EQ(engine_, nullptr);
}

TEST_F(SessionTest, ListsScenes) {
    testing::internal::CaptureStdout();
    run({"--list-scenes"});
    const std::string text = testing::internal::GetCapturedStdout();
    EXPECT_NE(("\n" + text).find("\ncornell-box-lights  "), std::string::npos) << text;
    testing::internal::CaptureStdout();
    run({"--list-scenes", "--json"});
    const Json list = Json::parse(testing::internal::GetCapturedStdout());
    EXPECT_EQ(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')), list.size());
    EXPECT_EQ(engine_, nullptr);
}

} // namespace
} // namespace rt::app
