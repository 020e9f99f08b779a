#include <algorithm>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "Common/App/Interactive/RunHistory.h"
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
        r.relmse = 0.1;
        r.hasReference = true;
        r.curve = {{0.5, 0.4}, {1.5, 0.1}};
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
        for (std::size_t i = 1; i < RunHistory::kMostLines; ++i) out << toJsonLine(record("old")) << '\n';
    }
    history.append(record("last"));
    EXPECT_EQ(lines(), RunHistory::kMostLines);
    EXPECT_EQ(history.records().front().scene, "old");
    EXPECT_EQ(history.records().back().scene, "last");
}

TEST_F(RunHistoryTest, ConcurrentAppendsLoseNothing) {
    constexpr int kThreads = 4, kEach = 25;
    std::vector<std::thread> threads;
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

} // namespace
} // namespace rt::app
