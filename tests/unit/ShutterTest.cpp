// Motion blur: which sample is of which time, what the flag takes, and how a render is kept and told of.
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Session/Frames.h"
#include "Common/App/Session/RenderJob.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Image/Checkpoint.h"
#include "Common/Render/ShutterEngine.h"
#include "RayTracingCPU/CpuEngine.h"
#include "tests/unit/MovingModels.h"
#include "tests/unit/SessionFixture.h"
#include "tests/unit/Statistics.h"

namespace rt::app {
namespace {

using test::bytesOfFile;

TEST(ShutterPoses, TakeAllSamplesInTurnAndLessOfThemPerPoseAtFirst) {
    std::uint32_t sample = 0, poses = 0;
    const auto posesUpTo = [&](std::uint32_t end) {
        while (sample < end) {
            const PoseOfSample pose = poseOfSample(sample);
            for (std::uint32_t s = sample; s < pose.end; ++s) {
                EXPECT_EQ(poseOfSample(s).pose, pose.pose) << s;
                EXPECT_EQ(poseOfSample(s).level, pose.level) << s;
            }
            EXPECT_GT(pose.end, sample);
            sample = pose.end;
            ++poses;
        }
        EXPECT_EQ(sample, end);
        return poses;
    };
    EXPECT_EQ(posesUpTo(64), 64u);
    EXPECT_EQ(posesUpTo(256), 160u);
    EXPECT_EQ(posesUpTo(1024), 352u);
    EXPECT_EQ(posesUpTo(4096), 736u);
    const PoseOfSample last = poseOfSample(0x7ffffffeu); // the most that a render may have
    EXPECT_EQ(last.end, 0x80000000u);
}

// Any 2^n poses in a row that begin at a multiple of 2^n have one time in each of 2^n equal parts of the interval.
TEST(ShutterPoses, AreStratifiedWhereverARenderEnds) {
    for (const std::uint32_t level : {0u, 1u, 5u})
        for (std::uint32_t count = 1; count <= 64; count *= 2)
            for (std::uint32_t first = 0; first < 128; first += count) {
                std::set<std::uint32_t> parts;
                for (std::uint32_t p = first; p < first + count; ++p) {
                    const double time = timeOfPose(7, 3, {level, p, 0});
                    ASSERT_TRUE(time >= 0 && time < 1);
                    parts.insert(static_cast<std::uint32_t>(time * count));
                }
                ASSERT_EQ(parts.size(), count) << "level " << level << ", from " << first;
            }
}

// Over seeds, and over replicates, each pose has any time: nothing of the interval is preferred. Four standard errors.
TEST(ShutterPoses, HaveUniformTimesThatReplicatesDoNotShare) {
    test::Mean bySeed, byReplicate, product;
    for (std::uint32_t i = 0; i < 4000; ++i) {
        const double a = timeOfPose(i, 0, {0, 5, 0}), b = timeOfPose(0, i, {2, 17, 0});
        bySeed.add(a);
        byReplicate.add(b);
        product.add((a - 0.5) * (timeOfPose(i, 1, {0, 5, 0}) - 0.5));
    }
    EXPECT_NEAR(bySeed.mean(), 0.5, 4 * bySeed.standardError());
    EXPECT_NEAR(bySeed.variance(), 1.0 / 12, 0.01);
    EXPECT_NEAR(byReplicate.mean(), 0.5, 4 * byReplicate.standardError());
    EXPECT_NEAR(product.mean(), 0, 4 * product.standardError());
}

class ShutterTest : public SessionFixture {
  protected:
    std::string movingLamp() const { return scene::saveMovingLamp(folder_ / "lamp.glb").string(); }

    static std::vector<std::string> joined(std::vector<std::string> flags, const std::vector<std::string>& more) {
        flags.insert(flags.end(), more.begin(), more.end());
        return flags;
    }
    // Of a real engine: the fixture's does not see the scene.
    ExitCode render(std::vector<std::string> arguments) {
        return runSession(options(std::move(arguments)), [] { return cpu::makeCpuEngine({}); });
    }
    std::string failure(std::vector<std::string> arguments) {
        try {
            render(std::move(arguments));
        } catch (const Error& error) {
            return std::to_string(static_cast<int>(error.code())) + " " + error.what();
        }
        return "no error";
    }
};

TEST_F(ShutterTest, FlagsThatMakeNoSenseAreRefused) {
    for (const char* bad :
         {"1", "0.2,0.1", "nan,1", "0,nan", "0,inf", "a,b", "0,1,2", "0,", ",1", ",", "0,2e9", " 0,1"})
        EXPECT_EQ(error<UsageError>({"--shutter", bad, "-o", "a.png"}).rfind("--shutter", 0), 0u) << bad;
    const std::vector<std::string> blur = {"--shutter", "0,0.1"};
    EXPECT_NE(error<UsageError>(joined(blur, {"--adaptive", "on", "-o", "a.png"})).find("not with --shutter"),
              std::string::npos);
    EXPECT_EQ(error<UsageError>(joined(blur, {"--export-scene", "a.json"})),
              "--shutter: only to render; --time poses a scene");
    std::ostringstream out;
    EXPECT_TRUE(parseOptions("ray-tracing-cpu", joined(blur, {"--no-config"}), out)->window);
    EXPECT_TRUE(parseOptions("ray-tracing-cpu", {"--no-config", "--shutter", "0,0"}, out)->window);
}

TEST_F(ShutterTest, OneThatDoesNotOpenIsATime) {
    const Options shifted = options({"--time", "2", "--shutter", "-0.5,-0.5", "-o", "a.png"});
    EXPECT_FALSE(shifted.shutter.isOpen());
    EXPECT_DOUBLE_EQ(shifted.moment.time, 1.5);
    EXPECT_EQ(options({"--shutter", "-3,-3", "-o", "a.png"}).moment.time, 0);
    const Options sequence = options({"--shutter", "-3,-3", "--frames", "0..96", "-o", "a.png"});
    EXPECT_EQ(optionsOfFrame(sequence, 48).moment.time, 0);
    EXPECT_EQ(optionsOfFrame(sequence, 96).moment.time, 1); // 24 a second
    const std::string scene = movingLamp();
    EXPECT_EQ(render({"--scene", scene, "--spp", "4", "--time", "0.5", "-o", path("a.pfm")}), ExitCode::Done);
    EXPECT_EQ(render({"--scene", scene, "--spp", "4", "--time", "0.5", "--shutter", "0,0", "-o", path("b.pfm")}),
              ExitCode::Done);
    EXPECT_EQ(render({"--scene", scene, "--spp", "4", "--shutter", "0.5,0.5", "-o", path("c.pfm")}), ExitCode::Done);
    EXPECT_EQ(bytesOfFile(path("a.pfm")), bytesOfFile(path("b.pfm")));
    EXPECT_EQ(bytesOfFile(path("a.pfm")), bytesOfFile(path("c.pfm")));
}

// Nothing is done otherwise: neither engine nor statistics know of a shutter.
TEST_F(ShutterTest, OfASceneInWhichNothingMovesItCountsForNothing) {
    const std::vector<std::string> flags = {"--spp", "4", "--stats", path("stats.json"), "-o"};
    EXPECT_EQ(render(joined(flags, {path("a.pfm")})), ExitCode::Done);
    EXPECT_EQ(render(joined(flags, {path("b.pfm"), "--shutter", "0,0.1"})), ExitCode::Done);
    EXPECT_EQ(bytesOfFile(path("a.pfm")), bytesOfFile(path("b.pfm")));
    EXPECT_FALSE(statistics().contains("shutter"));
}

TEST_F(ShutterTest, StatisticsAndPicturesTellOfIt) {
    EXPECT_EQ(render({"--scene", movingLamp(), "--spp", "66", "--time", "0.25", "--shutter", "-0.125,0.5", "--stats",
                      path("stats.json"), "-o", path("a.png")}),
              ExitCode::Done);
    const nlohmann::json shutter = statistics().at("shutter");
    EXPECT_EQ(shutter.at("open"), 0.125);
    EXPECT_EQ(shutter.at("close"), 0.75);
    EXPECT_EQ(shutter.at("poses"), 65); // two samples for the last
    EXPECT_NE(bytesOfFile(path("a.png")).find("\"--shutter\",\"-0.125,0.5\""), std::string::npos);
    EXPECT_EQ(statistics().at("spp_done"), 66);
    EXPECT_GT(statistics().at("rays").at("camera"), 66 * 20 * 12 - 1);
}

// Whatever the replicates, and wherever a render ends: in a pose, and in a block of the film.
TEST_F(ShutterTest, GoesOnBitForBit) {
    const std::string scene = movingLamp();
    for (const char* replicates : {"1", "2", "3"}) {
        const std::vector<std::string> flags = {"--scene",      scene,      "--shutter", "0,1",
                                                "--replicates", replicates, "--seed",    "5"};
        const auto at = [&](const char* spp, const std::vector<std::string>& more) {
            return render(joined(joined(flags, {"--spp", spp}), more));
        };
        EXPECT_EQ(at("75", {"-o", path("whole.pfm"), "--checkpoint", path("whole.rtc")}), ExitCode::Done);
        EXPECT_EQ(at("7", {"--checkpoint", path("part.rtc")}), ExitCode::Done);
        EXPECT_EQ(at("73", {"--resume", path("part.rtc"), "--checkpoint", path("part.rtc")}), ExitCode::Done);
        EXPECT_EQ(at("75", {"--resume", path("part.rtc"), "-o", path("parts.pfm"), "--checkpoint", path("parts.rtc")}),
                  ExitCode::Done);
        EXPECT_EQ(bytesOfFile(path("whole.pfm")), bytesOfFile(path("parts.pfm"))) << replicates;
        EXPECT_EQ(bytesOfFile(path("whole.rtc")), bytesOfFile(path("parts.rtc"))) << replicates;
    }
}

TEST_F(ShutterTest, RegionsAndTilesArePartsOfTheImage) {
    const std::vector<std::string> flags = {"--scene", movingLamp(), "--shutter", "0,1", "--spp", "20"};
    const std::vector<std::string> one = {"--tiles", "1/2", "--checkpoint", path("1.rtc")};
    EXPECT_EQ(render(joined(flags, {"-o", path("whole.pfm"), "--checkpoint", path("whole.rtc")})), ExitCode::Done);
    EXPECT_EQ(render(joined(flags, {"--tiles", "1/2", "--checkpoint", path("1.rtc")})), ExitCode::Done);
    const image::Film whole = image::readCheckpoint(path("whole.rtc")).film;
    const image::Film part = image::readCheckpoint(path("1.rtc")).film;
    std::size_t rendered = 0;
    for (std::uint32_t tile = 0; tile < part.tileCount(); ++tile) {
        if (part.samples(tile, 0) == 0) continue;
        ++rendered;
        const auto a = part.state(tile, 0).sums, b = whole.state(tile, 0).sums;
        EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end())) << tile;
    }
    EXPECT_GT(rendered, 0u);
    EXPECT_LT(rendered, part.tileCount());
    EXPECT_EQ(render(joined(flags, {"--region", "0,0,8,8", "-o", path("region.pfm")})), ExitCode::Done);
}

TEST_F(ShutterTest, ACheckpointOfAnotherShutterIsRefused) {
    const std::vector<std::string> flags = {"--scene", movingLamp(), "--spp", "4", "--time", "0.5"};
    EXPECT_EQ(render(joined(flags, {"--shutter", "-0.25,0.25", "--checkpoint", path("blur.rtc")})), ExitCode::Done);
    EXPECT_EQ(render(joined(flags, {"--checkpoint", path("sharp.rtc")})), ExitCode::Done);
    EXPECT_EQ(failure(joined(flags, {"--shutter", "-0.125,0.125", "--resume", path("blur.rtc")})),
              "3 " + path("blur.rtc") + R"(: shutter is "0.25,0.75" in the checkpoint but "0.375,0.625" now)");
    EXPECT_EQ(failure(joined(flags, {"--resume", path("blur.rtc")})),
              "3 " + path("blur.rtc") + R"(: shutter is "0.25,0.75" in the checkpoint but "off" now)");
    EXPECT_EQ(failure(joined(flags, {"--shutter", "-0.25,0.25", "--resume", path("sharp.rtc")})),
              "3 " + path("sharp.rtc") + R"(: shutter is "off" in the checkpoint but "0.25,0.75" now)");
}

// A lamp that goes one way and one that goes back are the same scene in the middle of the shutter.
TEST_F(ShutterTest, ACheckpointOfAnotherMotionIsRefused) {
    const auto backAndForth = [this](const char* name, float from) {
        scene::MovingModel model;
        const int lamp = model.addNode({{"mesh", model.addMesh(model.lamp(0.5f, 4))}});
        model.addCamera();
        model.move(lamp, "translation", {from, 0, 0}, {-from, 0, 0});
        return model.save(path(name)).string();
    };
    const std::vector<std::string> flags = {"--spp", "4", "--shutter", "0,1"};
    EXPECT_EQ(render(joined(flags, {"--scene", backAndForth("a.gltf", 0.5f), "--checkpoint", path("a.rtc")})),
              ExitCode::Done);
    const std::string said =
        failure(joined(flags, {"--scene", backAndForth("b.gltf", -0.5f), "--resume", path("a.rtc")}));
    EXPECT_EQ(said.rfind("3 " + path("a.rtc") + ": motion_hash is", 0), 0u) << said;
}

// Each frame has its shutter about its own time.
TEST_F(ShutterTest, GoesWithASequence) {
    const std::string scene = movingLamp();
    EXPECT_EQ(render({"--scene", scene, "--spp", "4", "--shutter", "0,0.1", "--frames", "1..2", "--frame-rate", "4",
                      "-o", path("a.pfm")}),
              ExitCode::Done);
    EXPECT_EQ(render({"--scene", scene, "--spp", "4", "--shutter", "0,0.1", "--time", "0.5", "-o", path("b.pfm")}),
              ExitCode::Done);
    EXPECT_EQ(bytesOfFile(path("a.0002.pfm")), bytesOfFile(path("b.pfm")));
    EXPECT_NE(bytesOfFile(path("a.0001.pfm")), bytesOfFile(path("b.pfm")));
}

// Poses are compiled for it alone, so only where one is kept.
TEST_F(ShutterTest, WhatTellsMotionsApartIsMadeWhenItIsAskedFor) {
    std::vector<double> posed;
    const PoseScene poses = [&posed, scene = compile(SceneRequest{"cornell-box-lights"})](double seconds) {
        posed.push_back(seconds);
        return scene;
    };
    const auto engine = makeShutterEngine(cpu::makeCpuEngine({}), 0.25, 0.75, poses);
    ASSERT_TRUE(engine->setScene(poses(0.5), nullptr));
    EXPECT_EQ(posed, std::vector<double>{0.5});
    const std::uint64_t hash = engine->motionHash();
    EXPECT_EQ(posed, (std::vector<double>{0.5, 0.25, 0.75}));
    EXPECT_EQ(engine->motionHash(), hash);
    EXPECT_EQ(posed.size(), 3u);
}

// A light that is not there at first.
TEST_F(ShutterTest, AllPosesMustHaveTheFeaturesThatAreForced) {
    scene::MovingModel model;
    model.addNode({{"mesh", model.addMesh(model.lamp(0.5f, 4))}});
    const int light = model.addLight({0, 0, 1}, 1);
    model.json["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = "directional";
    model.addCamera();
    model.move(light, "scale", {0, 0, 0}, {1, 1, 1});
    const std::vector<std::string> flags = {"--scene", model.save(path("a.gltf")).string(), "-o", path("a.pfm")};
    ASSERT_EQ(render(joined(flags, {"--spp", "1", "--stats", path("stats.json")})), ExitCode::Done);
    const nlohmann::json told = statistics();
    std::string names;
    for (const auto& name : told.at("features")) names += (names.empty() ? "" : ",") + name.get<std::string>();
    const std::vector<std::string> forced = joined(flags, {"--features", names, "--spp", "64"});
    EXPECT_EQ(failure(forced), "no error");
    const std::string said = "2 --features: the scene also needs";
    EXPECT_EQ(failure(joined(forced, {"--time", "0.5"})).rfind(said, 0), 0u);
    EXPECT_EQ(failure(joined(forced, {"--shutter", "-0.5,0.25"})).rfind(said, 0), 0u); // its middle is before that
}

// The model of a scene file moves, with what the file has changed of it; without the flags it stands at its time.
TEST_F(ShutterTest, MovesWhatASceneFileImports) {
    movingLamp();
    std::ofstream(path("own.json")) << R"({"version": 1, "import": {"file": "lamp.glb", "time": 0.25}, "objects": []})";
    const auto picture = [&](const std::string& name, const std::vector<std::string>& more) {
        EXPECT_EQ(render(joined({"--scene", path(name), "--spp", "4", "-o", path("a.pfm")}, more)), ExitCode::Done);
        return bytesOfFile(path("a.pfm"));
    };
    const std::string quarter = picture("lamp.glb", {"--time", "0.25"}), half = picture("lamp.glb", {"--time", "0.5"});
    EXPECT_NE(quarter, half);
    EXPECT_EQ(picture("own.json", {}), quarter);
    EXPECT_EQ(picture("own.json", {"--time", "0.5"}), half);
    EXPECT_EQ(picture("own.json", {"--time", "0"}), picture("lamp.glb", {}));
    EXPECT_EQ(picture("own.json", {"--shutter", "0.25,0.25"}), half); // after its own time
    EXPECT_EQ(picture("own.json", {"--shutter", "0,0.25"}),
              picture("lamp.glb", {"--time", "0.25", "--shutter", "0,0.25"}));
    EXPECT_EQ(render({"--scene", path("own.json"), "--spp", "4", "--frames", "0..1", "--frame-rate", "4", "-o",
                      path("f.pfm")}),
              ExitCode::Done);
    EXPECT_EQ(bytesOfFile(path("f.0000.pfm")), quarter);
    EXPECT_EQ(bytesOfFile(path("f.0001.pfm")), half);
    EXPECT_EQ(failure({"--scene", path("own.json"), "--animation", "none", "-o", path("a.pfm")}).rfind("2 --anim", 0),
              0u);
}

// Who has waited long enough gets what there is at once, though poses are still to come.
TEST_F(ShutterTest, IsCalledOff) {
    RenderJob job(options({"--scene", movingLamp(), "--spp", "1000000", "--shutter", "0,1", "-o", path("a.pfm")}));
    job.load();
    const std::atomic<bool> goOn{false}, stop{true};
    ASSERT_TRUE(job.begin(cpu::makeCpuEngine({}), goOn));
    EXPECT_FALSE(job.slice(0.01, goOn));
    EXPECT_EQ(job.slice(10, stop), StopReason::Interrupted);
    job.write(stop);
    EXPECT_GT(job.statistics().outputs.size(), 0u);
}

} // namespace
} // namespace rt::app
