// Checkpoints of a session, and renders that go on from them.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Image/Checkpoint.h"
#include "Common/Render/Names.h"
#include "tests/unit/SessionFixture.h"

namespace rt::app {
namespace {

namespace fs = std::filesystem;
using test::bytesOfFile;

class SessionResumeTest : public SessionFixture {};

TEST_F(SessionResumeTest, ResumesToTheSameBits) {
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
            EXPECT_NE(bytesOfFile(path("part.pfm")), bytesOfFile(path("whole.pfm")));
            run(with({"--resume", path("c.rtc"), "-o", path("part.pfm"), "--stats", path("stats.json")}));
            EXPECT_EQ(bytesOfFile(path("part.pfm")), bytesOfFile(path("whole.pfm")));
            EXPECT_EQ(statistics()["spp_done"], 75);
        }
}

TEST_F(SessionResumeTest, ResumesToMoreSamples) {
    run({"--spp", "20", "--checkpoint", path("c.rtc")});
    run({"--spp", "50", "--resume", path("c.rtc"), "-o", path("a.pfm")});
    run({"--spp", "50", "-o", path("b.pfm")});
    EXPECT_EQ(bytesOfFile(path("a.pfm")), bytesOfFile(path("b.pfm")));
    EXPECT_EQ(error<InputError>({"--spp", "19", "--resume", path("c.rtc")}),
              path("c.rtc") + ": spp is at 20 in the checkpoint already but 19 now");
}

TEST_F(SessionResumeTest, CheckpointsOfAnotherRenderAreRefused) {
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
    refused({"--edge-rays", "off"}, "edge_rays");
    refused({"--path-reuse", "off"}, "path_reuse");
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

// As they were before there were connections, before camera rays were split, and before pixels shared paths.
TEST_F(SessionResumeTest, CheckpointsThatDoNotTellOfAMethodDidWithout) {
    const auto runWithout = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(),
                         {"--specular-connections", "off", "--edge-rays", "off", "--path-reuse", "off"});
        run(arguments);
    };
    runWithout({"--spp", "4", "--checkpoint", path("c.rtc")});
    image::Checkpoint checkpoint = image::readCheckpoint(path("c.rtc"));
    for (const char* field : image::kLaterFields) ASSERT_EQ(checkpoint.render.erase(field), 1u);
    image::writeCheckpoint(path("c.rtc"), checkpoint.render, checkpoint.film);
    const auto errorWith = [&](const std::string& flag) {
        std::vector<std::string> arguments = {"--spp", "8", "--resume", path("c.rtc")};
        for (const char* field : {"specular_connections", "edge_rays", "path_reuse"})
            arguments.insert(arguments.end(), {flagOf(field), flagOf(field) == flag ? "on" : "off"});
        return error<InputError>(arguments);
    };
    const std::string told = R"( is "off" in the checkpoint (of a program that had no choice) but "on" now)";
    EXPECT_EQ(errorWith("--specular-connections"), path("c.rtc") + ": specular_connections" + told);
    EXPECT_EQ(errorWith("--edge-rays"), path("c.rtc") + ": edge_rays" + told);
    EXPECT_EQ(errorWith("--path-reuse"), path("c.rtc") + ": path_reuse" + told);
    runWithout({"--spp", "8", "--resume", path("c.rtc"), "-o", path("a.pfm")});
    runWithout({"--spp", "8", "-o", path("b.pfm")});
    EXPECT_EQ(bytesOfFile(path("a.pfm")), bytesOfFile(path("b.pfm")));
}

TEST_F(SessionResumeTest, DamagedCheckpointsAreRefused) {
    run({"--spp", "4", "--checkpoint", path("c.rtc")});
    const std::string whole = bytesOfFile(path("c.rtc"));
    const auto resumed = [&](const std::string& bytes) {
        std::ofstream(path("bad.rtc"), std::ios::binary) << bytes;
        return error<InputError>({"--spp", "8", "--resume", path("bad.rtc")});
    };
    for (const std::size_t size : {std::size_t{0}, std::size_t{7}, std::size_t{30}, whole.size() / 2, whole.size() - 1})
        EXPECT_EQ(resumed(whole.substr(0, size)).rfind(path("bad.rtc") + ": ", 0), 0u) << size;
    EXPECT_EQ(resumed("P6 1 1 255 ...").rfind(path("bad.rtc") + ": ", 0), 0u);
    EXPECT_NE(error<InputError>({"--resume", path("missing.rtc")}).find("missing.rtc"), std::string::npos);
}

TEST_F(SessionResumeTest, SavesEverySoOften) {
    bool seen = false;
    const auto look = [&](std::uint32_t) { seen = seen || fs::exists(path("a.png.rtc")); };
    run({"--spp", "50", "-o", path("a.png"), "--save-every", "1e-9"}, look);
    EXPECT_TRUE(seen);
    run({"--spp", "60", "-o", path("b.pfm"), "--resume", path("a.png.rtc")});
    EXPECT_FALSE(fs::exists(path("b.pfm.rtc")));
}

} // namespace
} // namespace rt::app
