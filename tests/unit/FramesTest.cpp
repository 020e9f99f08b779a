// Sequences of pictures: their names and times, what is left as it is, and what goes on.
#include <algorithm>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Session/Frames.h"
#include "Common/App/Session/SceneSource.h"
#include "tests/unit/GltfBuilder.h"
#include "tests/unit/SessionFixture.h"

namespace rt::app {
namespace {

namespace fs = std::filesystem;
using test::bytesOfFile;

class FramesTest : public SessionFixture {
  protected:
    // A triangle that moves along x by 1 a second, in a file.
    std::string movingTriangle() const {
        scene::GltfBuilder gltf;
        const int node = gltf.addNode({{"mesh", gltf.addMesh(gltf.triangle())}});
        const nlohmann::json sampler = {{"input", gltf.addAccessor(std::vector<float>{0, 9}, "SCALAR")},
                                        {"output", gltf.addAccessor(std::vector<float>{0, 0, 0, 9, 0, 0}, "VEC3")}};
        gltf.add("animations",
                 {{"samplers", {sampler}},
                  {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}}}}});
        return gltf.save(folder_ / "moving.glb").string();
    }
    std::vector<std::string> names() const {
        std::vector<std::string> found;
        for (const auto& entry : fs::directory_iterator(path("out"))) found.push_back(entry.path().filename().string());
        std::sort(found.begin(), found.end());
        return found;
    }
};

TEST_F(FramesTest, EachHasItsNameAndTime) {
    const Options sequence =
        options({"--frames", "7..12345", "--frame-rate", "10", "--time", "2", "-o", "a/b.c.png", "--stats", "s.json"});
    const Options frame = optionsOfFrame(sequence, 7);
    EXPECT_EQ(frame.outputs, std::vector<std::string>{(fs::path("a") / "b.c.0007.png").string()});
    EXPECT_EQ(frame.stats, "s.0007.json");
    EXPECT_DOUBLE_EQ(frame.moment.time, 2.7);
    EXPECT_FALSE(frame.frames);
    EXPECT_EQ(optionsOfFrame(sequence, 12345).outputs.front(), (fs::path("a") / "b.c.12345.png").string());
    EXPECT_DOUBLE_EQ(optionsOfFrame(options({"--frames", "0..48", "-o", "a.png"}), 48).moment.time, 2.0); // 24 a second
}

TEST_F(FramesTest, WritesASequenceAndLeavesWhatIsThere) {
    fs::create_directory(path("out"));
    const std::vector<std::string> flags = {"--scene",  movingTriangle(), "--spp",   "2",
                                            "--frames", "0..2",           "-o",      path("out/a.pfm"),
                                            "--aov",    "depth",          "--stats", path("out/s.json")};
    EXPECT_EQ(run(flags), ExitCode::Done);
    const std::vector<std::string> all = {"a.0000.depth.pfm", "a.0000.pfm",       "a.0001.depth.pfm",
                                          "a.0001.pfm",       "a.0002.depth.pfm", "a.0002.pfm",
                                          "s.0000.json",      "s.0001.json",      "s.0002.json"};
    EXPECT_EQ(names(), all);
    const auto hashOf = [this](const std::string& name) {
        return nlohmann::json::parse(bytesOfFile(path("out/" + name))).at("scene_hash").get<std::string>();
    };
    EXPECT_NE(hashOf("s.0000.json"), hashOf("s.0001.json"));
    EXPECT_EQ(nlohmann::json::parse(bytesOfFile(path("out/s.0002.json"))).at("frame"), 2);
    // One of the files of frame 1 is missing: that frame alone is rendered again.
    fs::remove(path("out/a.0001.depth.pfm"));
    scene::GltfBuilder::write(path("out/a.0000.pfm"), "mine");
    scene::GltfBuilder::write(path("out/a.0001.pfm"), "broken");
    EXPECT_EQ(run(flags), ExitCode::Done);
    EXPECT_EQ(names(), all);
    EXPECT_EQ(bytesOfFile(path("out/a.0000.pfm")), "mine");
    EXPECT_NE(bytesOfFile(path("out/a.0001.pfm")), "broken");
    EXPECT_EQ(run(flags), ExitCode::Done);
    EXPECT_EQ(engine_, nullptr); // nothing was to be done
}

TEST_F(FramesTest, AnInterruptedOneGoesOnBitForBit) {
    fs::create_directory(path("out"));
    const std::vector<std::string> flags = {"--scene",  movingTriangle(), "--spp", "40",
                                            "--frames", "3..4",           "-o",    path("out/a.pfm")};
    EXPECT_EQ(run(flags), ExitCode::Done);
    const std::string first = bytesOfFile(path("out/a.0003.pfm")), second = bytesOfFile(path("out/a.0004.pfm"));
    fs::remove(path("out/a.0003.pfm"));
    fs::remove(path("out/a.0004.pfm"));
    const auto interruptAt17 = [](std::uint32_t spp) {
        if (spp == 17) std::raise(SIGINT);
    };
    EXPECT_EQ(run(flags, interruptAt17), ExitCode::Interrupted);
    EXPECT_EQ(names(), (std::vector<std::string>{"a.0003.pfm", "a.0003.pfm.rtc"})); // what there is of it
    EXPECT_NE(bytesOfFile(path("out/a.0003.pfm")), first);
    EXPECT_EQ(run(flags), ExitCode::Done);
    EXPECT_EQ(names(), (std::vector<std::string>{"a.0003.pfm", "a.0004.pfm"}));
    EXPECT_EQ(bytesOfFile(path("out/a.0003.pfm")), first);
    EXPECT_EQ(bytesOfFile(path("out/a.0004.pfm")), second);
}

TEST_F(FramesTest, WhatItDoesNotGoTogetherWithIsRefused) {
    EXPECT_EQ(error<UsageError>({"--frames", "0..2"}), "--frames: needs --output");
    EXPECT_EQ(error<UsageError>({"--frames", "0..2", "-o", "a.png", "--checkpoint", "c.rtc"}),
              "--checkpoint: not with --frames, which goes on by itself");
    EXPECT_NE(error<UsageError>({"--frames", "0..2", "-o", "a.png", "--stats", "-"}).find("must be a file"),
              std::string::npos);
    for (const char* bad : {"3", "3..2", "..4", "a..b", "0..10000000"})
        EXPECT_EQ(error<UsageError>({"--frames", bad, "-o", "a.png"}).rfind("--frames", 0), 0u) << bad;
    for (const char* bad : {"-1", "nan", "2e9"})
        EXPECT_EQ(error<UsageError>({"--time", bad, "-o", "a.png"}).rfind("--time", 0), 0u) << bad;
    EXPECT_EQ(error<UsageError>({"--animation", "walk", "-o", path("a.png")}),
              "--animation walk: the scene has no animations");
}

// Who asks for a time, or for frames, knows that the scene moves, also where the time is its start.
TEST_F(FramesTest, OnlyThoseWhoAskedForNoTimeAreToldThatThereAreOthers) {
    const auto isTold = [this](const scene::Moment& moment) {
        for (const std::string& notice : loadScene(movingTriangle(), moment).notices)
            if (notice.find("--time poses it") != std::string::npos) return true;
        return false;
    };
    EXPECT_TRUE(isTold(options({"-o", "a.png"}).moment));
    EXPECT_FALSE(isTold(options({"--time", "0", "-o", "a.png"}).moment));
    EXPECT_FALSE(isTold(optionsOfFrame(options({"--frames", "0..2", "-o", "a.png"}), 0).moment));
}

// The camera and the studio of a model that has neither stay where they are.
TEST_F(FramesTest, WhatSurroundsAModelStandsStill) {
    const std::string file = movingTriangle();
    const scene::SceneDesc start = loadScene(file), later = loadScene(file, {"", 4});
    EXPECT_EQ(later.camera, start.camera);
    EXPECT_EQ(later.prototypes, start.prototypes);
    EXPECT_NE(later.objects, start.objects);
}

} // namespace
} // namespace rt::app
