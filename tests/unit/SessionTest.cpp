// What a session writes of its render: outputs, statistics, errors against a reference; and what ends it.
#include <algorithm>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "Common/Image/ImageIo.h"
#include "tests/unit/SessionFixture.h"

namespace rt::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using test::bytesOfFile;

class SessionTest : public SessionFixture {};

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
    const std::string linear = bytesOfFile(path("a.pfm"));
    const float before = image::readImage(path("a.png")).data[0];
    run({"--spp", "2", "-o", path("a.png"), "-o", path("a.pfm"), "--exposure", "-1"});
    EXPECT_EQ(bytesOfFile(path("a.pfm")), linear);
    EXPECT_NEAR(image::readImage(path("a.png")).data[0], before / 2, 0.01f);
    run({"--spp", "2", "-o", path("a.png"), "-o", path("a.pfm"), "--tonemap", "reinhard"});
    EXPECT_EQ(bytesOfFile(path("a.pfm")), linear);
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

TEST_F(SessionTest, WritesWhatMirrorsAndGlassShow) {
    run({"--spp", "40", "-o", path("a.pfm"), "-o", path("b.png"), "--aov",
         "wide-albedo,wide-normal,wide-depth,emission"});
    EXPECT_EQ(image::readImage(path("a.wide-albedo.pfm")).data[0], 0.125f);
    EXPECT_EQ(image::readImage(path("a.wide-normal.pfm")).data[0], 1.0f);
    EXPECT_EQ(image::readImage(path("a.wide-depth.pfm")).data[0], 16.0f);
    EXPECT_EQ(image::readImage(path("a.emission.pfm")).data[0], 4.0f);
    EXPECT_FALSE(fs::exists(path("a.albedo.pfm")));
    EXPECT_NEAR(image::readImage(path("b.wide-albedo.png")).data[0], 0.125f, 0.01f);
    EXPECT_EQ(image::readImage(path("b.wide-normal.png")).data[0], 1.0f);
    EXPECT_EQ(image::readImage(path("b.wide-depth.png")).data[0], 1.0f);
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
                            "edge_rays", "path_reuse", "sampler", "one_sided_lights", "russian_roulette", "replicates"})
        EXPECT_TRUE(stats["settings"].contains(key)) << key;
    for (const char* key : {"load", "accel_build", "pipeline", "render", "render_device", "write"})
        EXPECT_GE(stats["seconds"].at(key).get<double>(), 0.0) << key;
    EXPECT_EQ(stats["rays"]["camera"], 10);
    EXPECT_EQ(stats["rays"]["scattered"], 20);
    EXPECT_EQ(stats["rays"]["shadow"], 30);
    EXPECT_EQ(stats["rays"]["edge"], 40);
    EXPECT_EQ(stats["rays"]["reuse"], 50);
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
    EXPECT_EQ(statistics()["error"]["flip"], 0.0);
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
