// Renders that mpirun shares out to several processes: the bits of one, whatever happens to the others.
#ifdef RT_MPIEXEC

#include <algorithm>

#include "Common/Image/Checkpoint.h"
#include "Common/Image/ImageIo.h"
#include "tests/program/Program.h"

namespace rt::test {
namespace {

class Ranks : public ProgramTest {
  protected:
    // Open MPI refuses by default what tests do: more ranks than processors, as root.
    static Environment launcher() {
        return {{"OMPI_ALLOW_RUN_AS_ROOT", "1"},
                {"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"},
                {"OMPI_MCA_rmaps_base_oversubscribe", "1"},
                {"OMPI_MCA_hwloc_base_binding_policy", "none"}};
    }
    Outcome mpirun(int ranks, Arguments arguments, const std::string& program = "ray-tracing-cpu") const {
        arguments.insert(arguments.begin(), {"-n", std::to_string(ranks), programPath(program), "-q"});
        return run(RT_MPIEXEC, arguments, launcher());
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

// The benchmark starts them by itself; their picture has the error of one process to the last digit.
TEST_F(Ranks, AreMeasured) {
    writeFile("suite.json", R"({"version": 1, "experiments": [{"name": "ranks", "scene": "one-weekend-default",
        "width": 32, "threads": 1, "ranks": [1, 2], "spp": [16, 32]}]})");
    Environment environment = launcher();
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
    const std::string program = programPath("ray-tracing-cpu");
    const Outcome outcome = run(RT_MPIEXEC,
                                {"-n", "1", program, "-q", "--headless", "-o", "a.pfm", ":", "-n", "1", program, "-q",
                                 "--headless", "-o", "a.pfm", "--scene", "furnace"},
                                launcher());
    EXPECT_TRUE(endsWith(outcome, 3, "another scene"));
}

#ifndef _WIN32

// Rank 0 has about a second, with Open MPI; the exit code is the launcher's own.
TEST_F(Ranks, SignalsToTheLauncherKeepWhatThereIs) {
    const Arguments size = {"--width", "24", "--height", "24", "--threads", "1"};
    for (const char* signal : {"INT", "TERM"}) {
        std::filesystem::remove(path("c.rtc"));
        Arguments command = {
            "-c",
            "\"$0\" \"$@\" & until [ -s c.rtc ]; do sleep 0.02; done; kill -" + std::string(signal) + " $!; wait $!",
            RT_MPIEXEC,
            "-n",
            "2",
            programPath("ray-tracing-cpu"),
            "-q",
            "--headless",
            "--spp",
            "2147483647",
            "--time-limit", // in rounds: all tiles are alike far
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
        run("/bin/sh", command, launcher());
        EXPECT_EQ(jsonOf("s.json")["stopped_by"], "interrupted");
        EXPECT_EQ(image::readImage(path("interrupted.pfm")).width, 24u);
        expectToGoOn(size);
    }
}

// Rank 1 of two dies, or stops, once there is a checkpoint.
class EndedRanks : public Ranks {
  protected:
    Outcome runUntil(const std::string& checkpoint, const std::string& end, Arguments arguments) const {
        const std::string program = programPath("ray-tracing-cpu");
        arguments.insert(arguments.begin(), {"--headless", "--width", "24", "--height", "24", "--threads", "1",
                                             "--checkpoint", "c.rtc", "--save-every", "0.05"});
        Arguments all = {"-n", "1", program};
        all.insert(all.end(), arguments.begin(), arguments.end());
        all.insert(all.end(), {":", "-n", "1", "sh", "-c",
                               "\"$0\" \"$@\" & until " + checkpoint + "; do sleep 0.02; done; " + end, program});
        all.insert(all.end(), arguments.begin(), arguments.end());
        return run(RT_MPIEXEC, all, launcher());
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

// From the pilot, and from what follows the plan, whose checkpoint is smaller as it lacks the pilot's squares.
TEST_F(EndedRanks, AdaptiveSamplesGoOnToo) {
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

TEST_F(Ranks, MakeTheBitsOfOneProcessOnGpus) {
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
