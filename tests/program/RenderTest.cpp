// What renders leave behind: formats, statistics, the same bits however they were reached.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "Common/Image/ImageIo.h"
#include "tests/program/Program.h"

namespace rt::test {
namespace {

class Render : public ProgramTest {};

double mean(const image::Image& image) {
    return std::accumulate(image.data.begin(), image.data.end(), 0.0) / static_cast<double>(image.data.size());
}

TEST_F(Render, EachFormatHoldsTheSamePicture) {
    ASSERT_EQ(render({"-o", "a.pfm", "--outfile", "a.exr", "--output", "a.HDR", "-o", "a.png"}).exitCode, 0);
    const image::Image pfm = image::readImage(path("a.pfm"));
    EXPECT_EQ(pfm.width, 32u);
    EXPECT_EQ(pfm.height, 32u);
    EXPECT_GT(mean(pfm), 0.05);
    EXPECT_EQ(image::readImage(path("a.exr")).data, pfm.data);
    const image::Image hdr = image::readImage(path("a.HDR"));
    const image::Image png = image::readImage(path("a.png"));
    for (std::size_t i = 0; i < pfm.data.size(); ++i) {
        const float brightest = *std::max_element(&pfm.data[i / 3 * 3], &pfm.data[i / 3 * 3] + 3);
        EXPECT_NEAR(hdr.data[i], pfm.data[i], brightest / 128 + 1e-6f); // 8 bits, shared exponent
        EXPECT_NEAR(png.data[i], std::min(pfm.data[i], 1.0f), 0.01f);
    }
}

TEST_F(Render, ImagesBesideThePicture) {
    ASSERT_EQ(
        render({"-o", "a.exr", "-o", "b.png", "--aov", "albedo,normal,depth,variance,samples", "--spp", "40"}).exitCode,
        0);
    for (const char* aov : {"albedo", "normal", "depth", "variance", "samples"})
        for (const char* name : {"a.", "b."}) {
            const image::Image image =
                image::readImage(path(name + std::string(aov) + (name[0] == 'a' ? ".exr" : ".png")));
            EXPECT_EQ(image.width, 32u) << aov;
            EXPECT_GT(std::abs(mean(image)), 0.0) << aov;
        }
    const image::Image samples = image::readImage(path("a.samples.exr"));
    EXPECT_EQ(samples.data, std::vector<float>(samples.data.size(), 40.0f));
    const image::Image normal = image::readImage(path("a.normal.exr"));
    for (std::size_t i = 0; i < normal.data.size(); i += 3)
        EXPECT_LE(std::hypot(normal.data[i], normal.data[i + 1], normal.data[i + 2]), 1.001f);
}

TEST_F(Render, ExposureChangesPngOnly) {
    ASSERT_EQ(render({"-o", "a.pfm", "-o", "a.png", "--exposure", "-2", "--tonemap", "aces"}).exitCode, 0);
    ASSERT_EQ(render({"-o", "b.pfm", "-o", "b.png"}).exitCode, 0);
    EXPECT_EQ(bytesOf("a.pfm"), bytesOf("b.pfm"));
    EXPECT_LT(mean(image::readImage(path("a.png"))), mean(image::readImage(path("b.png"))));
}

TEST_F(Render, AnyThreadsAndPolicyGiveTheSameBits) {
    const std::string expected = pixels({"--spp", "19", "--threads", "1", "--policy", "seq"});
    for (const char* policy : {"seq", "par", "par_unseq"})
        for (const char* threads : {"1", "2", "5"})
            EXPECT_TRUE(pixels({"--spp", "19", "--threads", threads, "--policy", policy}) == expected)
                << policy << threads;
    EXPECT_TRUE(pixels({"--spp", "19", "--engine", "single"}) == expected);
    EXPECT_FALSE(pixels({"--spp", "19", "--seed", "1"}) == expected);
    EXPECT_FALSE(pixels({"--spp", "20"}) == expected);
}

TEST_F(Render, MoreFeaturesThanNeededChangeNothing) {
    EXPECT_TRUE(pixels({"--features", "all"}) == pixels({}));
    ASSERT_EQ(render({"--features", "all", "--stats", "stats.json"}).exitCode, 0);
    EXPECT_TRUE(jsonOf("stats.json")["skipped"].empty());
}

// Where it matters only.
TEST_F(Render, TellsWhatMaxDepthHasCutOff) {
    const auto renderTo = [&](const std::string& depth) {
        return cpu({"--headless", "--no-config", "--scene", "cornell-box-lights", "--width", "32", "--spp", "16",
                    "--max-depth", depth, "--stats", path("stats.json")});
    };
    const Outcome shallow = renderTo("2");
    ASSERT_EQ(shallow.exitCode, 0) << shallow.err;
    EXPECT_NE(shallow.err.find("max depth 2 has cut off "), std::string::npos) << shallow.err;
    EXPECT_GT(jsonOf("stats.json")["cut_off_share"], 0.1);
    const Outcome deep = renderTo("50");
    ASSERT_EQ(deep.exitCode, 0) << deep.err;
    EXPECT_EQ(deep.err.find("has cut off"), std::string::npos) << deep.err;
    EXPECT_LT(jsonOf("stats.json")["cut_off_share"], 0.01);
}

TEST_F(Render, StatisticsAreThoseOfTheContract) {
    const Outcome outcome =
        render({"--spp", "33", "--max-depth", "7", "--seed", "5", "--stats", "-", "--engine", "single"});
    ASSERT_EQ(outcome.exitCode, 0);
    const auto stats = nlohmann::json::parse(outcome.out);
    for (const char* key : {"version",
                            "app",
                            "scene",
                            "engine",
                            "device",
                            "threads",
                            "width",
                            "height",
                            "spp",
                            "spp_done",
                            "max_depth",
                            "seed",
                            "stopped_by",
                            "settings",
                            "features",
                            "kernel",
                            "skipped",
                            "seconds",
                            "samples_per_second",
                            "rays",
                            "mean_radiance",
                            "standard_error",
                            "nonfinite_samples",
                            "cut_off_share",
                            "estimated_relmse",
                            "estimated_relmse_interval",
                            "error_is",
                            "memory",
                            "outputs"})
        EXPECT_TRUE(stats.contains(key)) << key;
    EXPECT_EQ(stats["version"], 1);
    EXPECT_EQ(stats["app"], "ray-tracing-cpu");
    EXPECT_EQ(stats["scene"], "cornell-box-lights");
    EXPECT_EQ(stats["engine"], "single");
    EXPECT_EQ(stats["spp_done"], 33);
    EXPECT_EQ(stats["max_depth"], 7);
    EXPECT_EQ(stats["seed"], 5);
    EXPECT_EQ(stats["stopped_by"], "spp");
    EXPECT_EQ(stats["rays"]["camera"], 32 * 32 * 33);
    EXPECT_GT(stats["rays"]["scattered"], 0);
    EXPECT_GT(stats["rays"]["shadow"], 0);
    EXPECT_GT(stats["seconds"]["render"], 0.0);
    EXPECT_EQ(stats["nonfinite_samples"], 0);
    EXPECT_GT(stats["estimated_relmse"], 0.0);
    for (int c = 0; c < 3; ++c) {
        EXPECT_GT(stats["mean_radiance"][c], 0.0);
        EXPECT_GT(stats["standard_error"][c], 0.0);
    }
    const double rate = stats["samples_per_second"].get<double>() * stats["seconds"]["render"].get<double>();
    EXPECT_NEAR(rate, 32 * 32 * 33, 1);
}

// Two seeds differ by what their replicates say they do.
TEST_F(Render, ReplicatesGiveHonestErrors) {
    nlohmann::json stats[2];
    for (int seed = 0; seed < 2; ++seed) {
        ASSERT_EQ(
            render({"--spp", "64", "--replicates", "8", "--seed", std::to_string(seed), "--stats", "s.json"}).exitCode,
            0);
        stats[seed] = jsonOf("s.json");
        EXPECT_EQ(stats[seed]["error_is"], "replicates");
    }
    for (int c = 0; c < 3; ++c) {
        const double difference =
            stats[0]["mean_radiance"][c].get<double>() - stats[1]["mean_radiance"][c].get<double>();
        const double sigma =
            std::hypot(stats[0]["standard_error"][c].get<double>(), stats[1]["standard_error"][c].get<double>());
        EXPECT_LT(std::abs(difference), 4 * sigma);
    }
}

TEST_F(Render, ReferenceAddsErrorFigures) {
    ASSERT_EQ(render({"-o", "reference.exr", "--spp", "256"}).exitCode, 0);
    ASSERT_EQ(render({"--reference", "reference.exr", "--seed", "1", "--stats", "s.json"}).exitCode, 0);
    const auto error = jsonOf("s.json")["error"];
    EXPECT_GT(error["mse"], 0.0);
    EXPECT_NEAR(error["rmse"].get<double>() * error["rmse"].get<double>(), error["mse"].get<double>(), 1e-9);
    for (const char* key : {"relmse", "mae", "psnr", "flip"}) EXPECT_GT(error[key], 0.0) << key;
}

TEST_F(Render, TimeLimit) {
    // So small that a slow build on a busy machine comes to a sample as well.
    ASSERT_EQ(cpu({"-q", "--headless", "--width", "8", "--height", "8", "--spp", "2147483647", "--time-limit", "0.5",
                   "-o", "a.pfm", "--stats", "s.json"})
                  .exitCode,
              0);
    const auto stats = jsonOf("s.json");
    EXPECT_EQ(stats["stopped_by"], "time_limit");
    EXPECT_GT(stats["spp_done"], 0);
    EXPECT_EQ(stats["spp"], 2147483647);
    EXPECT_GT(mean(image::readImage(path("a.pfm"))), 0.05);
}

TEST_F(Render, TargetError) {
    ASSERT_EQ(render({"--spp", "1000000", "--target-error", "0.05", "--stats", "s.json"}).exitCode, 0);
    const auto stats = jsonOf("s.json");
    EXPECT_EQ(stats["stopped_by"], "target_error");
    EXPECT_LT(stats["estimated_relmse_interval"][1], 0.05);
    EXPECT_GE(stats["settings"]["replicates"], 4);
}

// The noise of 64 samples, much of it fireflies of the glass sphere, was once stated as 0.6 of what it is, and so ended
// a render with a target of 0.03 at an error of 0.05.
TEST_F(Render, StatedErrorsCountFireflies) {
    const auto stated = [this](Arguments more) {
        more.insert(more.begin(), {"-q", "--headless", "--no-config", "--scene", "cornell-box-lights", "--width", "48",
                                   "--seed", "9", "--stats", "s.json", "--reference", "reference.exr"});
        EXPECT_EQ(cpu(more).exitCode, 0);
        return jsonOf("s.json");
    };
    ASSERT_EQ(
        render({"--width", "48", "--height", "48", "--spp", "2048", "--seed", "1", "-o", "reference.exr"}).exitCode, 0);
    const auto few = stated({"--spp", "64", "--replicates", "4"});
    EXPECT_NEAR(few["estimated_relmse"].get<double>() / few["error"]["relmse"].get<double>(), 1, 0.25);
    const auto target = stated({"--spp", "4000", "--target-error", "0.03"});
    EXPECT_EQ(target["stopped_by"], "target_error");
    EXPECT_LT(target["error"]["relmse"], 0.033); // the reference has an error of its own
}

TEST_F(Render, ResumedRendersHaveTheBitsOfUninterruptedOnes) {
    for (const Arguments& settings :
         {Arguments{"--sampler", "sobol"}, Arguments{"--sampler", "independent", "--replicates", "3"}}) {
        const auto with = [&settings](Arguments more) {
            more.insert(more.begin(), settings.begin(), settings.end());
            return more;
        };
        const std::string whole = pixels(with({"--spp", "45"}));
        ASSERT_EQ(render(with({"--spp", "21", "--checkpoint", "c.rtc"})).exitCode, 0);
        EXPECT_TRUE(pixels(with({"--spp", "45", "--resume", "c.rtc"})) == whole);
        EXPECT_TRUE(pixels(with({"--spp", "45", "--resume", "c.rtc", "--threads", "1", "--policy", "seq"})) == whole);
    }
}

TEST_F(Render, CheckpointsOfOtherRendersAreRefused) {
    ASSERT_EQ(render({"--checkpoint", "c.rtc"}).exitCode, 0);
    EXPECT_TRUE(failsWith(render({"--resume", "c.rtc", "--seed", "1"}), 3, "seed"));
    EXPECT_TRUE(failsWith(render({"--resume", "c.rtc", "--width", "33"}), 3, "width"));
    EXPECT_TRUE(failsWith(render({"--resume", "c.rtc", "--one-sided-lights", "off"}), 3, "scene_hash"));
    EXPECT_TRUE(failsWith(render({"--resume", "c.rtc", "--spp", "3"}), 3, "spp"));
}

TEST_F(Render, FilesAreReplacedWholly) {
    writeFile("a.png", "something else");
    ASSERT_EQ(render({"-o", "a.png", "--stats", "s.json", "--save-every", "0.001"}).exitCode, 0);
    EXPECT_EQ(bytesOf("a.png").substr(1, 3), "PNG");
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
        ++files;
        EXPECT_TRUE(entry.path().filename() == "a.png" || entry.path().filename() == "s.json" ||
                    entry.path().filename() == "a.png.rtc")
            << entry.path();
    }
    EXPECT_EQ(files, 3u);
}

} // namespace
} // namespace rt::test
