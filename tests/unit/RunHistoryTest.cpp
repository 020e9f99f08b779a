#include <algorithm>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "Common/App/Interactive/RunHistory.h"
#include "Common/Render/Names.h"
#include "tests/TempFolder.h"

namespace rt::app {
namespace {

class RunHistoryTest : public ::testing::Test {
  protected:
    static RunRecord record(const std::string& scene) {
        RunRecord r;
        r.time = utcNow();
        r.app = "ray-tracing-cpu";
        r.engine = "multi";
        r.device = "a \"quoted\", device";
        r.scene = scene;
        r.lightSampling = "mis";
        r.sampler = "sobol";
        r.width = 600;
        r.height = 400;
        r.spp = 5'000'000'000;
        r.renderSeconds = 1.5;
        r.samplesPerSecond = 1e6;
        r.sceneHash = "0123456789abcdef";
        r.camera = R"({"look_from":[0.0,0.0,1.0]})";
        r.lightSelection = "contribution";
        r.sphereLight = r.quadLight = r.triangleLight = "auto";
        r.russianRoulette = r.oneSidedLights = "on";
        r.adaptive = r.specularConnections = r.edgeRays = r.pathReuse = "off";
        r.relmse = 0.1;
        r.hasReference = true;
        r.referenceError = 0.001;
        r.curve = {{0.5, 0.4}, {1.5, 0.1}};
        return r;
    }
    static RunRecord gpuRecord(const std::string& scene) {
        RunRecord r = record(scene);
        r.app = "ray-tracing-gpu";
        r.engine = "compute";
        return r;
    }
    std::size_t lines() const {
        std::ifstream in(file());
        std::size_t count = 0;
        for (std::string line; std::getline(in, line);) ++count;
        return count;
    }
    std::filesystem::path file() const { return folder_ / "deep" / "history.jsonl"; }

    test::TempFolder folder_;
};

TEST_F(RunHistoryTest, GivesBackWhatWasAppended) {
    RunHistory history(file());
    EXPECT_TRUE(history.records().empty());
    history.append(record("a"));
    history.append(record("b"));
    ASSERT_EQ(history.records().size(), 2u);
    EXPECT_EQ(history.records()[0], record("a"));
    EXPECT_EQ(history.records()[1].scene, "b");
    EXPECT_NEAR(history.records()[0].efficiency(), 1 / 0.15, 1e-9);
}

TEST_F(RunHistoryTest, ReplicatesArePartOfTheWork) {
    RunRecord other = record("a");
    EXPECT_TRUE(isSameWork(record("a"), other));
    other.replicates = "2";
    EXPECT_FALSE(isSameWork(record("a"), other));
    EXPECT_TRUE(isSamePicture(record("a"), other)); // more samples come to the same
    RunHistory history(file());
    history.append(other);
    ASSERT_EQ(history.records().size(), 1u);
    EXPECT_EQ(history.records()[0].replicates, "2");
}

TEST_F(RunHistoryTest, SeesWhatAnotherProgramAppends) {
    RunHistory ours(file()), theirs(file());
    ours.append(record("a"));
    EXPECT_EQ(theirs.records().size(), 1u);
    ours.append(record("b"));
    EXPECT_EQ(theirs.records().size(), 2u);
}

TEST_F(RunHistoryTest, LinesThatAreDamagedAreLeftOutButKept) {
    RunHistory history(file());
    history.append(record("a"));
    std::ofstream(file(), std::ios::app) << "{\"version\": 1, \"time\"\n[1,2]\n{\"version\": 99}\nnull\n";
    history.append(record("b"));
    ASSERT_EQ(history.records().size(), 2u);
    EXPECT_EQ(history.records()[1].scene, "b");
    EXPECT_EQ(lines(), 6u);
}

TEST_F(RunHistoryTest, KeepsTheLastTenThousandLines) {
    RunHistory history(file());
    history.append(record("first"));
    {
        std::ofstream out(file(), std::ios::app);
        for (std::size_t i = 1; i < RunHistory::kMaxLines; ++i) out << toJsonLine(record("old")) << '\n';
    }
    history.append(record("last"));
    EXPECT_EQ(lines(), RunHistory::kMaxLines);
    EXPECT_EQ(history.records().front().scene, "old");
    EXPECT_EQ(history.records().back().scene, "last");
}

TEST_F(RunHistoryTest, RemovesWhatItIsToldToAndNothingElse) {
    RunHistory history(file()), theirs(file());
    for (const char* scene : {"a", "b", "c"}) history.append(record(scene));
    std::ofstream(file(), std::ios::app) << "{\"version\": 99}\n";
    ASSERT_EQ(theirs.records().size(), 3u);
    history.remove({history.records()[1]});
    ASSERT_EQ(history.records().size(), 2u);
    EXPECT_EQ(history.records()[0].scene, "a");
    EXPECT_EQ(history.records()[1].scene, "c");
    EXPECT_EQ(theirs.records().size(), 2u);
    history.remove(history.records());
    EXPECT_TRUE(history.records().empty());
    EXPECT_EQ(lines(), 1u); // of a later version
}

TEST_F(RunHistoryTest, WithoutAFileItLastsAsLongAsTheProgram) {
    RunHistory history({});
    std::thread([&] { history.append(record("a")); }).join();
    history.append(record("b"));
    ASSERT_EQ(history.records().size(), 2u);
    history.remove(history.records());
    EXPECT_TRUE(history.records().empty());
}

TEST_F(RunHistoryTest, ConcurrentAppendsLoseNothing) {
    constexpr int kThreads = 4, kEach = 25;
    std::vector<std::thread> threads;
    threads.reserve(kThreads);
    for (int t = 0; t < kThreads; ++t)
        threads.emplace_back([this, t] {
            RunHistory history(file());
            for (int i = 0; i < kEach; ++i) history.append(record(std::to_string(t)));
        });
    for (std::thread& thread : threads) thread.join();
    RunHistory history(file());
    EXPECT_EQ(history.records().size(), std::size_t{kThreads} * kEach);
    EXPECT_EQ(lines(), std::size_t{kThreads} * kEach);
}

TEST_F(RunHistoryTest, CsvQuotesWhatHasCommas) {
    const std::string csv = toCsv({record("a")});
    EXPECT_NE(csv.find("\"a \"\"quoted\"\", device\""), std::string::npos) << csv;
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 2);
}

// The line is as programs wrote it before records told their whole work.
TEST_F(RunHistoryTest, OldRecordsLoadAndSayWhatTheyLack) {
    std::filesystem::create_directories(file().parent_path());
    std::ofstream(file()) << R"({"version":1,"time":"2026-01-31T12:00:00Z","app":"ray-tracing-cpu","engine":"multi",)"
                          << R"("device":"d","scene":"a","light_sampling":"mis","sampler":"sobol","width":8,)"
                          << R"("height":8,"spp":16,"max_depth":50,"threads":2,"seconds":{"load":0,"accel_build":0,)"
                          << R"("pipeline":0,"render":1},"samples_per_second":1024,"rays_per_second":0,"relmse":0,)"
                          << R"("against_reference":false,"curve":[]})" << '\n';
    RunHistory history(file());
    ASSERT_EQ(history.records().size(), 1u);
    const RunRecord& old = history.records()[0];
    EXPECT_EQ(old.spp, 16u);
    EXPECT_EQ(lackingIn(old),
              "scene_hash, camera, light_selection, sphere_light, quad_light, triangle_light, "
              "russian_roulette, one_sided_lights, adaptive");
    EXPECT_EQ(old.specularConnections, "off"); // there was nothing else
    EXPECT_EQ(old.edgeRays, "off");
    EXPECT_EQ(old.pathReuse, "off");
    EXPECT_FALSE(isSameWork(old, old)); // what is not known is not equal
    EXPECT_EQ(lackingIn(record("a")), "");
}

// Work that differs in a method is not the same work, whoever adds one.
TEST_F(RunHistoryTest, RecordsTellEveryMethod) {
    const nlohmann::json line = nlohmann::json::parse(toJsonLine(record("a")));
    RenderSettings settings;
    forEachMethod([&line](const char* key, const char*, const char*, const auto&,
                          const auto&) { EXPECT_TRUE(line.contains(key)) << key; },
                  settings);
}

TEST_F(RunHistoryTest, OnlyEqualWorkIsTheSame) {
    const RunRecord cpu = record("a");
    EXPECT_TRUE(isSameWork(cpu, gpuRecord("a"))); // by whom is left free
    using Change = void (*)(RunRecord&);
    for (const Change change : {
             Change([](RunRecord& r) { r.scene = "b"; }),
             Change([](RunRecord& r) { r.sceneHash = "0"; }),
             Change([](RunRecord& r) { r.camera = "{}"; }),
             Change([](RunRecord& r) { ++r.width; }),
             Change([](RunRecord& r) { ++r.height; }),
             Change([](RunRecord& r) { ++r.spp; }),
             Change([](RunRecord& r) { ++r.maxDepth; }),
             Change([](RunRecord& r) { r.lightSampling = "bsdf"; }),
             Change([](RunRecord& r) { r.lightSelection = "power"; }),
             Change([](RunRecord& r) { r.sphereLight = "area"; }),
             Change([](RunRecord& r) { r.quadLight = "area"; }),
             Change([](RunRecord& r) { r.triangleLight = "area"; }),
             Change([](RunRecord& r) { r.sampler = "independent"; }),
             Change([](RunRecord& r) { r.russianRoulette = "off"; }),
             Change([](RunRecord& r) { r.oneSidedLights = "off"; }),
             Change([](RunRecord& r) { r.adaptive = "on"; }),
             Change([](RunRecord& r) { r.specularConnections = "on"; }),
             Change([](RunRecord& r) { r.edgeRays = "on"; }),
             Change([](RunRecord& r) { r.pathReuse = "on"; }),
         }) {
        RunRecord gpu = gpuRecord("a");
        change(gpu);
        EXPECT_FALSE(isSameWork(cpu, gpu)) << toJsonLine(gpu);
    }
}

TEST_F(RunHistoryTest, TheNewestRunsOfEqualWorkAreCompared) {
    RunRecord other = gpuRecord("a");
    other.sampler = "independent";
    const RunRecord cpu = record("a"), newerCpu = record("a"), gpu = gpuRecord("a");
    const EnginePair pair = newestOfEqualWork({&other, &newerCpu, &gpu, &cpu});
    EXPECT_EQ(pair.cpu, &newerCpu);
    EXPECT_EQ(pair.gpu, &gpu);
    EXPECT_EQ(newestOfEqualWork({&other, &newerCpu, &cpu}).gpu, nullptr);
}

} // namespace
} // namespace rt::app
