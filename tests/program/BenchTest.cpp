// ray-tracing-bench from the outside: a suite of a second or two, its files, comparisons, errors.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "tests/program/Program.h"

#ifndef _WIN32
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#endif

namespace rt::test {
namespace {

constexpr const char* kSuite = R"({
  "version": 1, "title": "Tiny", "reference_seconds": 20,
  "experiments": [
    {"name": "samplers", "scene": "one-weekend-default", "engine": ["single", "multi"], "width": 32,
     "sampler": ["sobol", "independent"], "spp": [2, 4], "repeats": 3, "baseline": {"sampler": "independent"}},
    {"name": "skipped", "scene": "one-weekend-default", "engine": "multi", "width": 32, "features": ["auto", "all"],
     "spp": 16, "error": false}
  ]
})";

class Bench : public ProgramTest {
  protected:
    void SetUp() override {
        ProgramTest::SetUp();
        writeFile("suite.json", kSuite);
    }
    // References are kept in the test's own folder.
    Outcome bench(const Arguments& arguments) const {
        return run("ray-tracing-bench", arguments, {{"XDG_CACHE_HOME", path("cache")}});
    }
};

TEST_F(Bench, MeasuresAndReports) {
    const Outcome outcome = bench({"suite.json", "-q", "--report", "deep/report"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("# Tiny"), std::string::npos);
    for (const char* file : {"report.html", "report.md", "results.csv", "plot-1.svg"})
        EXPECT_FALSE(bytesOf(std::string("deep/report/") + file).empty()) << file;
    const auto results = jsonOf("deep/report/results.json");
    EXPECT_EQ(results["version"], 1);
    EXPECT_TRUE(results["complete"]);
    ASSERT_EQ(results["rows"].size(), 2u * 2 * 2 + 2);
    for (const auto& row : results["rows"]) {
        EXPECT_GT(row["seconds"], 0.0);
        EXPECT_GT(row["samples_per_second"], 0.0);
        if (row["experiment"] == "skipped") continue;
        EXPECT_GT(row["efficiency"], 0.0);
        EXPECT_LT(std::abs(row["bias_z"].get<double>()), 5.0); // of 24 images
        EXPECT_GT(row["flip"], 0.0);
    }
    // Both engines trace the same paths, so their errors are the same.
    EXPECT_EQ(results["rows"][0]["mse"], results["rows"][4]["mse"]);
    ASSERT_EQ(results["skipped_features"].size(), 1u);
    EXPECT_EQ(results["skipped_features"][0]["differing_pixels"], 0.0);
    EXPECT_TRUE(results["references"][0]["sufficient"]);
    EXPECT_FALSE(results["references"][0]["cached"]);
    const std::string csv = bytesOf("deep/report/results.csv");
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 11);

    ASSERT_EQ(bench({"suite.json", "-q", "--report", "again", "--engine", "multi"}).exitCode, 0);
    const auto again = jsonOf("again/results.json");
    EXPECT_TRUE(again["references"][0]["cached"]);
    EXPECT_EQ(again["rows"][0]["mse"], results["rows"][4]["mse"]); // seeds are the same
}

#ifdef RT_HAS_GPU

TEST_F(Bench, EnginesOfBothKindsVerifyTheReference) {
    writeFile("both.json", R"({"version": 1, "experiments": [{"name": "a", "scene": "one-weekend-default",
        "engine": ["multi", "pipeline"], "width": 64, "spp": [4], "baseline": {"engine": "multi"}}]})");
    const Outcome outcome = bench({"both.json", "-q", "--report", "r"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto results = jsonOf("r/results.json");
    ASSERT_EQ(results["rows"].size(), 2u);
    // Equal paths but for rounding: hardly another error, another time.
    EXPECT_NEAR(results["rows"][1]["mse"].get<double>() / results["rows"][0]["mse"].get<double>(), 1, 0.1);
    EXPECT_GT(results["rows"][1]["speedup"], 0.0);
    EXPECT_GT(results["rows"][1]["seconds_device"], 0.0);
    EXPECT_GT(results["rows"][1]["ceiling"], 0.0);
    const auto& reference = results["references"][0];
    EXPECT_NE(reference["verified_by"], "");
    EXPECT_LT(std::abs(reference["verified_z"].get<double>()), 4.0);
    EXPECT_TRUE(results["machine"].contains("GPU driver"));
}

#endif

TEST_F(Bench, ComparesReports) {
    ASSERT_EQ(bench({"suite.json", "-q", "--report", "a", "--engine", "single"}).exitCode, 0);
    const Outcome same = bench({"--compare", "a", "a/results.json"});
    EXPECT_EQ(same.exitCode, 0) << same.err;
    EXPECT_NE(same.out.find("0 of 4 rows are worse"), std::string::npos) << same.out;
    auto worse = jsonOf("a/results.json");
    worse["rows"][0]["mse"] = 100 * worse["rows"][0]["mse"].get<double>();
    writeFile("worse.json", worse.dump());
    const Outcome regression = bench({"--compare", "a", "worse.json"});
    EXPECT_EQ(regression.exitCode, 5);
    EXPECT_NE(regression.out.find("NOISIER"), std::string::npos);
    worse["rows"] = nlohmann::json::array();
    writeFile("nothing.json", worse.dump());
    EXPECT_TRUE(failsWith(bench({"--compare", "a", "nothing.json"}), 3, "no row"));
}

TEST_F(Bench, ErrorsAreOneLineAndHaveTheirCodes) {
    EXPECT_TRUE(failsWith(bench({"nonsense"}), 3, "predecessor"));
    EXPECT_TRUE(failsWith(bench({"missing.json"}), 3, "missing.json"));
    writeFile("bad.json", R"({"version": 1, "experiments": [{"name": "a", "spp": [4], "sampler": "halton"}]})");
    EXPECT_TRUE(failsWith(bench({"bad.json"}), 3, "/experiments/0/sampler"));
    EXPECT_TRUE(failsWith(bench({"suite.json", "-q", "--scene", "no-such-scene"}), 3, "no-such-scene"));
    EXPECT_TRUE(failsWith(bench({"--nonsense"}), 2, "--nonsense"));
    EXPECT_TRUE(failsWith(bench({"suite.json", "--engine", "quantum"}), 2, "pipeline"));
    EXPECT_TRUE(failsWith(bench({"suite.json", "--engine", "compute"}), 2, "none of these engines"));
    writeFile("file", "");
    EXPECT_TRUE(failsWith(bench({"suite.json", "--report", "file"}), 1, "file"));
    EXPECT_TRUE(failsWith(bench({"--compare", "suite.json", "suite.json"}), 3, "suite.json"));
    const Outcome suites = bench({"--list-suites"});
    EXPECT_EQ(suites.exitCode, 0);
    EXPECT_NE(suites.out.find("predecessor: "), std::string::npos);
}

#ifndef _WIN32

TEST_F(Bench, AnInterruptionKeepsWhatWasMeasured) {
    writeFile("long.json",
              R"({"version": 1, "experiments": [{"name": "a", "scene": "one-weekend-default", "engine": "single",
        "width": 32, "height": 32, "spp": 4, "error": false},
        {"name": "b", "scene": "one-weekend-default", "engine": "single", "width": 512, "spp": 2147483647,
         "max_seconds": 1000000, "error": false}]})");
    const std::string program = programPath("ray-tracing-bench"), log = path("log");
    const pid_t child = fork();
    if (child == 0) {
        const int file = open(log.c_str(), O_WRONLY | O_CREAT, 0600);
        if (file >= 0 && dup2(file, 2) >= 0 && dup2(file, 1) >= 0 && chdir(folder_.c_str()) == 0)
            execl(program.c_str(), program.c_str(), "long.json", "--report", "report", nullptr);
        _exit(99);
    }
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (bytesOf("log").find("# b") == std::string::npos && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    kill(child, SIGINT);
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 130);
    const auto results = jsonOf("report/results.json");
    EXPECT_FALSE(results["complete"]);
    ASSERT_EQ(results["rows"].size(), 1u);
    EXPECT_EQ(results["rows"][0]["experiment"], "a");
}

#endif

} // namespace
} // namespace rt::test
