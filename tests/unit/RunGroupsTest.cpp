// What a table and a chart say of several runs.
#include <algorithm>

#include <gtest/gtest.h>

#include "Common/App/Interactive/RunGroups.h"
#include "tests/unit/RunRecords.h"

namespace rt::app {
namespace {

RunRecord run(const std::string& program, std::uint64_t spp) {
    return test::runRecord(program, "mis", spp);
}

bool isSaidOnce(const RunGroups& groups, const std::string& title) {
    return std::any_of(groups.common.begin(), groups.common.end(),
                       [&](const WorkField& f) { return f.title == title; });
}

TEST(RunGroups, WhatDiffersIsAColumnAndEqualWorkStandsTogether) {
    const RunRecord cpu = run("ray-tracing-cpu", 16), more = run("ray-tracing-cpu", 64),
                    gpu = run("ray-tracing-gpu", 16);
    RunRecord moved = run("ray-tracing-cpu", 64);
    moved.camera = "{\"look_from\":[0,0,2]}";
    const RunGroups groups = groupByWork({&cpu, &more, &moved, &gpu});
    EXPECT_EQ(groups.groups, 3u);
    ASSERT_EQ(groups.columns.size(), 2u);
    EXPECT_STREQ(groups.columns[0], "Camera");
    EXPECT_STREQ(groups.columns[1], "SPP");
    ASSERT_EQ(groups.rows.size(), 4u);
    EXPECT_EQ(groups.rows[0].record, &cpu);
    EXPECT_EQ(groups.rows[1].record, &gpu); // beside what it can be compared with
    EXPECT_EQ(groups.rows[1].group, 0u);
    EXPECT_EQ(groups.rows[1].cells, (std::vector<std::string>{"1", "16"}));
    EXPECT_EQ(groups.rows[2].record, &more);
    EXPECT_EQ(groups.rows[3].cells, (std::vector<std::string>{"2", "64"}));
    EXPECT_TRUE(isSaidOnce(groups, "Scene"));
    EXPECT_TRUE(isSaidOnce(groups, "Depth"));
    EXPECT_FALSE(isSaidOnce(groups, "SPP"));
}

TEST(RunGroups, WhatARecordLacksIsAQuestion) {
    const RunRecord whole = run("ray-tracing-cpu", 16);
    RunRecord old = whole;
    old.camera.clear();
    const RunGroups groups = groupByWork({&whole, &old});
    EXPECT_EQ(groups.groups, 2u);
    ASSERT_EQ(groups.columns.size(), 1u);
    EXPECT_EQ(groups.rows[1].cells, std::vector<std::string>{"?"});
    EXPECT_EQ(groupByWork({}).groups, 0u);
}

// A tenth of the time for each sample and a twentieth of the time to the same error.
TEST(RunGroups, SpeedUpsAreOfSamplesAndOfTimeToEqualError) {
    RunRecord cpu = run("ray-tracing-cpu", 16), gpu = run("ray-tracing-gpu", 16);
    cpu.samplesPerSecond = 1e6;
    gpu.samplesPerSecond = 1e7;
    cpu.renderSeconds = 10;
    gpu.renderSeconds = 1;
    EXPECT_EQ(compareRuns(cpu, gpu).timeToEqualError, 0); // no error is known
    cpu.relmse = 0.02;
    gpu.relmse = 0.01;
    EXPECT_DOUBLE_EQ(compareRuns(cpu, gpu).samplesPerSecond, 10);
    EXPECT_DOUBLE_EQ(compareRuns(cpu, gpu).timeToEqualError, 20);
    EXPECT_FALSE(compareRuns(cpu, gpu).isMeasured);
    gpu.hasReference = true;
    EXPECT_EQ(compareRuns(cpu, gpu).timeToEqualError, 0); // an estimate and a measurement are two things
    cpu.hasReference = true;
    EXPECT_TRUE(compareRuns(cpu, gpu).isMeasured);
}

// Of five numbers each: medians 3 and 30 whatever their order; the ranges of the last two overlap.
TEST(RunGroups, EnginesAreToldApartWhereRepeatedRunsAre) {
    std::vector<RunRecord> runs;
    const auto add = [&runs](const char* program, double samplesPerSecond) {
        runs.push_back(run(program, 16));
        runs.back().samplesPerSecond = samplesPerSecond;
    };
    const auto compare = [&runs] {
        std::vector<RunRow> rows;
        rows.reserve(runs.size());
        for (const RunRecord& r : runs) rows.push_back({&r, 0, {}});
        return compareRepeats(pairOf(runs.front(), runs.back()), rows);
    };
    add("ray-tracing-cpu", 3);
    add("ray-tracing-gpu", 30);
    EXPECT_FALSE(compare().isKnown());
    EXPECT_DOUBLE_EQ(compare().ratio, 10);
    runs.clear();
    for (const double figure : {5.0, 1.0, 3.0, 2.0, 4.0}) add("ray-tracing-cpu", figure);
    runs.push_back(run("ray-tracing-cpu", 32)); // no repetition: of other work
    runs.back().samplesPerSecond = 100;
    for (const double figure : {30.0, 28.0, 36.0}) add("ray-tracing-gpu", figure);
    const RepeatedComparison apart = compare();
    ASSERT_TRUE(apart.isKnown());
    EXPECT_TRUE(apart.isToldApart());
    EXPECT_EQ(apart.first.count, 5u);
    EXPECT_DOUBLE_EQ(apart.ratio, 10);
    EXPECT_DOUBLE_EQ(apart.first.spread(), 4.0 / 3);
    EXPECT_DOUBLE_EQ(apart.second.spread(), 8.0 / 30);
    add("ray-tracing-gpu", 4.5);
    EXPECT_FALSE(compare().isToldApart());
    EXPECT_DOUBLE_EQ(compare().second.median, 29);
}

// Other work is compared by error * time, where both are of one picture.
TEST(RunGroups, OtherWorkIsComparedByError) {
    RunRecord fast = run("ray-tracing-cpu", 16), good = run("ray-tracing-cpu", 16);
    good.lightSampling = "bsdf";
    fast.samplesPerSecond = good.samplesPerSecond = 1;
    fast.renderSeconds = good.renderSeconds = 1;
    fast.relmse = 0.4;
    good.relmse = 0.1;
    const std::vector<RunRow> rows = {{&fast, 0, {}}, {&good, 1, {}}};
    const RepeatedComparison result = compareRepeats({&fast, &good}, rows);
    EXPECT_TRUE(result.isByError);
    EXPECT_DOUBLE_EQ(result.ratio, 4);
    good.camera = "elsewhere";
    EXPECT_EQ(compareRepeats({&fast, &good}, rows).ratio, 0);
    EXPECT_EQ(compareRuns(fast, good).timeToEqualError, 0);
}

TEST(RunGroups, AReferenceIsToBeThreeTimesAsGoodAsWhatItMeasures) {
    EXPECT_FALSE(isReferenceTooNoisy(0.09, 0.01));
    EXPECT_TRUE(isReferenceTooNoisy(0.0899, 0.01));
    EXPECT_FALSE(isReferenceTooNoisy(0.01, 0)); // nothing is known of it
}

} // namespace
} // namespace rt::app
