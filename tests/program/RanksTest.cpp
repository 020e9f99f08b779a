// Renders that mpirun shares out to several processes: the bits of one, whatever happens to the others.
#ifdef RT_MPIEXEC

#include <algorithm>
#include <thread>

#include "Common/Bench/RankedRun.h"
#include "Common/Image/Checkpoint.h"
#include "Common/Image/ImageIo.h"
#include "tests/program/Program.h"

namespace rt::test {
namespace {

class Ranks : public ProgramTest {
  protected:
    // Ranks as the benchmark starts them: Open MPI refuses by default more of them than there are processors.
    static const bench::RankLauncher& launcher() {
        static const bench::RankLauncher launcher = bench::rankLauncherAt(RT_MPIEXEC);
        return launcher;
    }
    // By mpirun itself or by a shell's script that has mpirun and its arguments in $0 and $@.
    Outcome launch(int ranks, const Arguments& command, const std::string& script = "") const {
        Arguments all = launcher().settings;
        all.insert(all.end(), {"-n", std::to_string(ranks)});
        all.insert(all.end(), command.begin(), command.end());
        if (script.empty()) return run(RT_MPIEXEC, all, asRoot());
        all.insert(all.begin(), {"-c", script, RT_MPIEXEC});
        return run("/bin/sh", all, asRoot());
    }
    static Environment asRoot() { return {{"OMPI_ALLOW_RUN_AS_ROOT", "1"}, {"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"}}; }
    Outcome mpirun(int ranks, Arguments arguments, const std::string& program = "ray-tracing-cpu") const {
        arguments.insert(arguments.begin(), {programPath(program), "-q"});
        return launch(ranks, arguments);
    }
    // A program as rank 0, and as the others what a shell does, with the program and its arguments in $0 and $@. mpirun
    // takes one command for all, as Open MPI 5.0.7 ends by a signal where it is told of two.
    static Arguments withOthers(const std::string& script) {
        return {"sh", "-c", "[ ${OMPI_COMM_WORLD_RANK:-$PMI_RANK} = 0 ] && exec \"$0\" \"$@\"; " + script,
                programPath("ray-tracing-cpu")};
    }
    std::string picture(int ranks, Arguments arguments, const std::string& program = "ray-tracing-cpu") const {
        arguments.insert(arguments.end(), {"--headless", "-o", "ranks.pfm"});
        const Outcome outcome = mpirun(ranks, arguments, program);
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        return bytesOf("ranks.pfm");
    }
    // c.rtc holds samples, from which three ranks get to the bits of a whole render.
    void expectToGoOn(const Arguments& size) const {
        const image::Film film = image::readCheckpoint(path("c.rtc")).film;
        std::uint64_t maximum = 0;
        for (std::uint32_t tile = 0; tile < film.tileCount(); ++tile) maximum = std::max(maximum, film.samples(tile));
        EXPECT_GT(maximum, 0u);
        Arguments rest = size;
        rest.insert(rest.end(), {"--spp", std::to_string(maximum + 5)});
        Arguments resumed = rest;
        resumed.insert(resumed.end(), {"--resume", "c.rtc"});
        EXPECT_TRUE(picture(3, resumed) == pixels(rest));
    }

    // Launchers change what they take and do from one series to the next: whatever fails, this is whose.
    testing::ScopedTrace launchedBy_{__FILE__, __LINE__, launcher().version};
};

// One message of ours, whatever the launcher adds to it.
testing::AssertionResult endsWith(const Outcome& outcome, int exitCode, const std::string& mentioning) {
    std::size_t lines = 0;
    for (std::size_t at = outcome.err.find("ray-tracing-cpu: "); at != std::string::npos;
         at = outcome.err.find("ray-tracing-cpu: ", at + 1))
        ++lines;
    if (outcome.exitCode == exitCode && lines == 1 && outcome.err.find(mentioning) != std::string::npos)
        return testing::AssertionSuccess();
    return testing::AssertionFailure() << "exit code " << outcome.exitCode << ", " << outcome.err;
}

#ifdef __linux__

// Frames of a sequence are whole pictures, each of one rank.
TEST_F(Ranks, EachRendersItsShareOfASequence) {
    const Arguments flags = {"--headless", "--spp", "2", "--width", "16", "--height", "16", "--frames", "0..4", "-o"};
    Arguments shared = flags, alone = flags;
    shared.push_back("ranks.pfm");
    alone.insert(alone.end(), {path("alone.pfm"), "-q"});
    const Outcome outcome = mpirun(3, shared);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    ASSERT_EQ(cpu(alone).exitCode, 0);
    for (const std::string number : {".0000.pfm", ".0001.pfm", ".0002.pfm", ".0003.pfm", ".0004.pfm"})
        EXPECT_TRUE(bytesOf("ranks" + number) == bytesOf("alone" + number)) << number;
}

// Each would have to pose the scene for each of its leases.
TEST_F(Ranks, RefuseToShareMotionBlurOfOnePicture) {
    EXPECT_TRUE(
        endsWith(mpirun(2, {"--headless", "--shutter", "0,0.1", "-o", "a.pfm"}), 2, "mpirun: not with --shutter"));
}

// What all other tests here, the benchmark and docs/many-machines.md count on: more ranks than processors, bound to none
// of them, who know how many they are.
TEST_F(Ranks, StartAsTheLauncherIsTold) {
    const unsigned ranks = 2 * std::thread::hardware_concurrency() + 1;
    const Arguments tell = {"sh", "-c", "echo of ${OMPI_COMM_WORLD_SIZE:-$PMI_SIZE} on $(nproc)"};
    const std::string processors = run("/bin/sh", {"-c", "nproc"}).out;
    const Outcome outcome = launch(static_cast<int>(ranks), tell);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    std::string expected;
    for (unsigned rank = 0; rank < ranks; ++rank) expected += "of " + std::to_string(ranks) + " on " + processors;
    EXPECT_EQ(outcome.out, expected);
}

#endif

// The benchmark starts them by itself; their picture has the error of one process to the last digit.
TEST_F(Ranks, AreMeasured) {
    writeFile("suite.json", R"({"version": 1, "experiments": [{"name": "ranks", "scene": "one-weekend-default",
        "width": 32, "threads": 1, "ranks": [1, 2], "spp": [16, 32]}]})");
    Environment environment = asRoot();
    environment["XDG_CACHE_HOME"] = path("cache");
    const Outcome outcome = run("ray-tracing-bench", {"suite.json", "-q", "--report", "report"}, environment);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto rows = jsonOf("report/results.json")["rows"];
    ASSERT_EQ(rows.size(), 4u) << outcome.out;
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(rows[i]["ranks"], 1);
        EXPECT_EQ(rows[i + 2]["ranks"], 2);
        for (const char* same : {"spp", "mse", "rays_per_sample"}) EXPECT_EQ(rows[i][same], rows[i + 2][same]) << same;
        EXPECT_GT(rows[i + 2]["samples_per_second"], 0.0);
    }
}

TEST_F(Ranks, MakeTheBitsOfOneProcess) {
    const Arguments odd = {"--width", "150", "--height", "101", "--spp", "37"};
    const std::string one = pixels(odd);
    for (const int ranks : {2, 3, 5}) EXPECT_TRUE(picture(ranks, odd) == one) << ranks;
    const Arguments rounds = {"--width", "64",           "--height", "64",           "--spp",
                              "150",     "--replicates", "4",        "--time-limit", "600"};
    EXPECT_TRUE(picture(3, rounds) == pixels(rounds));
    const Arguments region = {"--width", "150", "--height", "101", "--spp", "9", "--region", "21,13,100,50"};
    EXPECT_TRUE(picture(2, region) == pixels(region));
}

TEST_F(Ranks, MakeTheBitsOfOneProcessWithAdaptiveSamples) {
    const Arguments odd = {"--width", "150", "--height", "101", "--spp", "37", "--adaptive", "on"};
    const std::string one = pixels(odd);
    for (const int ranks : {2, 3, 5}) EXPECT_TRUE(picture(ranks, odd) == one) << ranks;
    const Arguments rounds = {"--width",      "64", "--height",     "64",  "--spp",      "150",
                              "--replicates", "4",  "--time-limit", "600", "--adaptive", "on"};
    EXPECT_TRUE(picture(3, rounds) == pixels(rounds));
}

// Rank 0 filters what all have rendered, adaptive films too.
TEST_F(Ranks, DenoiseToTheBitsOfOneProcess) {
    for (const char* adaptive : {"off", "on"}) {
        const Arguments odd = {"--width", "70",         "--height", "45",        "--spp",
                               "24",      "--adaptive", adaptive,   "--denoise", "only"};
        EXPECT_TRUE(picture(2, odd) == pixels(odd)) << adaptive;
    }
}

TEST_F(Ranks, StatisticsNameThem) {
    ASSERT_EQ(mpirun(3, {"--width", "64", "--height", "64", "--spp", "64", "--stats", "s.json"}).exitCode, 0);
    const auto stats = jsonOf("s.json");
    ASSERT_EQ(stats["ranks"].size(), 3u);
    std::uint64_t samples = 0;
    for (const auto& rank : stats["ranks"]) samples += rank["samples"].get<std::uint64_t>();
    EXPECT_GE(samples, 64u * 64u * 64u); // tiles that were handed out twice count twice
    EXPECT_EQ(stats["spp_done"], 64);
    EXPECT_EQ(stats["rays"]["camera"].get<std::uint64_t>() >= samples, true);
}

TEST_F(Ranks, ErrorsAreToldOnceWithTheirExitCode) {
    EXPECT_TRUE(endsWith(mpirun(3, {"--spp", "0", "-o", "a.pfm"}), 2, "--spp"));
    EXPECT_TRUE(endsWith(mpirun(3, {"--scene", "no-such-scene", "-o", "a.pfm"}), 3, "no-such-scene"));
    EXPECT_TRUE(endsWith(mpirun(2, {"-o", "no-such-folder/a.pfm"}), 1, "no-such-folder"));
    EXPECT_TRUE(endsWith(mpirun(2, {}), 2, "--headless"));
    EXPECT_TRUE(endsWith(mpirun(2, {"--list-scenes"}), 2, "mpirun"));
}

// A rank of another scene, as on a host whose files are others.
TEST_F(Ranks, MustHaveOneScene) {
    Arguments command = withOthers(R"(exec "$0" "$@" --scene furnace)");
    command.insert(command.end(), {"-q", "--headless", "-o", "a.pfm"});
    EXPECT_TRUE(endsWith(launch(2, command), 3, "another scene"));
}

#ifndef _WIN32

// Rank 0 has about a second, with Open MPI 4, and half a one with 5; the exit code is the launcher's own.
TEST_F(Ranks, SignalsToTheLauncherKeepWhatThereIs) {
    const Arguments size = {"--width", "24", "--height", "24", "--threads", "1"};
    for (const char* signal : {"INT", "TERM"}) {
        std::filesystem::remove(path("c.rtc"));
        // In rounds, by the limit of time: all tiles are alike far.
        Arguments command = {programPath("ray-tracing-cpu"),
                             "-q",
                             "--headless",
                             "--spp",
                             "2147483647",
                             "--time-limit",
                             "600",
                             "--checkpoint",
                             "c.rtc",
                             "--save-every",
                             "0.05",
                             "--stats",
                             "s.json",
                             "-o",
                             "interrupted.pfm"};
        command.insert(command.end(), size.begin(), size.end());
        launch(2, command,
               R"("$0" "$@" & until [ -s c.rtc ]; do sleep 0.02; done; kill -)" + std::string(signal) + " $!; wait $!");
        EXPECT_EQ(jsonOf("s.json")["stopped_by"], "interrupted");
        EXPECT_EQ(image::readImage(path("interrupted.pfm")).width, 24u);
        expectToGoOn(size);
    }
}

// Rank 1 of two dies, or stops, once there is a checkpoint.
class EndedRanks : public Ranks {
  protected:
    Outcome runUntil(const std::string& checkpoint, const std::string& end, const Arguments& arguments) const {
        Arguments command = withOthers(R"("$0" "$@" & until )" + checkpoint + "; do sleep 0.02; done; " + end);
        command.insert(command.end(), {"--headless", "--width", "24", "--height", "24", "--threads", "1",
                                       "--checkpoint", "c.rtc", "--save-every", "0.05"});
        command.insert(command.end(), arguments.begin(), arguments.end());
        return launch(2, command);
    }
    static constexpr const char* kExists = "[ -s c.rtc ]";
    Arguments size(const std::string& spp) const {
        return {"--width", "24", "--height", "24", "--threads", "1", "--spp", spp};
    }
};

TEST_F(EndedRanks, AKilledOneCostsLittleAndAnyNumberGoesOn) {
    EXPECT_NE(runUntil(kExists, "kill -9 $!; exit 9", {"--spp", "2147483647"}).exitCode, 0);
    expectToGoOn({"--width", "24", "--height", "24", "--threads", "1"});
}

using NightlyEndedRanks = EndedRanks;

// From the pilot, and from what follows the plan, whose checkpoint is smaller as it lacks the pilot's squares.
TEST_F(NightlyEndedRanks, AdaptiveSamplesGoOnToo) {
    Arguments rest = size("4000");
    rest.insert(rest.end(), {"--adaptive", "on"});
    const std::string one = pixels(rest);
    rest.insert(rest.end(), {"--resume", "c.rtc"});
    for (const char* checkpoint : {kExists, "[ -s c.rtc ] && [ $(wc -c < c.rtc) -lt 50000 ]"}) {
        std::filesystem::remove(path("c.rtc"));
        EXPECT_NE(runUntil(checkpoint, "kill -9 $!; exit 9", {"--spp", "4000", "--adaptive", "on"}).exitCode, 0);
        EXPECT_TRUE(picture(3, rest) == one) << checkpoint;
        EXPECT_TRUE(pixels(rest) == one) << checkpoint;
    }
}

// The files are written, all end by themselves, and the exit code says so.
TEST_F(EndedRanks, OneThatStopsForEverHoldsNobodyUp) {
    const Outcome outcome =
        runUntil(kExists, "kill -STOP $!; wait", {"--spp", "3000", "-o", "stopped.pfm", "--stats", "s.json"});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("rank 1 does not answer"), std::string::npos) << outcome.err;
    EXPECT_TRUE(bytesOf("stopped.pfm") == pixels(size("3000")));
    EXPECT_EQ(jsonOf("s.json")["spp_done"], 3000);
}

#endif

#ifdef RT_HAS_GPU

using NightlyRanks = Ranks;

TEST_F(NightlyRanks, MakeTheBitsOfOneProcessOnGpus) {
    const Arguments size = {"--engine", "compute", "--width", "70", "--height", "41", "--spp", "20", "--headless"};
    Arguments alone = size;
    alone.insert(alone.begin(), "-q");
    alone.insert(alone.end(), {"-o", "one.pfm"});
    ASSERT_EQ(run("ray-tracing-gpu", alone).exitCode, 0);
    EXPECT_TRUE(picture(2, size, "ray-tracing-gpu") == bytesOf("one.pfm"));
    Arguments adaptive = size;
    adaptive.insert(adaptive.end(), {"--adaptive", "on"});
    const std::string shared = picture(2, adaptive, "ray-tracing-gpu");
    adaptive.insert(adaptive.end(), {"-q", "-o", "adaptive.pfm"});
    ASSERT_EQ(run("ray-tracing-gpu", adaptive).exitCode, 0);
    EXPECT_TRUE(shared == bytesOf("adaptive.pfm"));
    for (const char* share : {"1/2", "2/2"}) {
        Arguments part = size;
        part.insert(part.end(), {"-q", "--tiles", share, "--checkpoint", std::string(1, *share) + ".rtc"});
        ASSERT_EQ(run("ray-tracing-gpu", part).exitCode, 0);
    }
    EXPECT_EQ(run("ray-tracing-image", {"merge", "2.rtc", "1.rtc", "-o", "merged.pfm"}).exitCode, 0);
    EXPECT_TRUE(bytesOf("merged.pfm") == bytesOf("one.pfm"));
}

// A lease is a quarter of the image at most. What else is on the device is far less than a film of the whole image.
TEST_F(Ranks, ReserveTheFilmOfALeaseOnGpus) {
    constexpr std::uint64_t kSide = 1024, kReplicates = 3;
    const std::uint64_t sums = 24, openBlock = 12; // bytes of a pixel and replicate
    const std::string side = std::to_string(kSide), replicates = std::to_string(kReplicates);
    const Outcome outcome =
        mpirun(2,
               {"--headless", "--engine", "compute", "--scene", "furnace", "--max-depth", "1", "--width", side,
                "--height", side, "--replicates", replicates, "--spp", replicates, "--stats", "s.json"},
               "ray-tracing-gpu");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_LT(jsonOf("s.json")["memory"]["device_bytes"].get<std::uint64_t>(),
              kSide * kSide * kReplicates * (sums + openBlock));
}

#endif

} // namespace
} // namespace rt::test

#endif
