// What the comparison shows of the history, and what is marked there.
#include <algorithm>

#include <gtest/gtest.h>

#include "Common/Gui/RunBoard.h"
#include "tests/unit/RunRecords.h"

namespace rt::gui {
namespace {

app::RunRecord run(const std::string& program, const std::string& estimator, const std::string& time) {
    app::RunRecord r = test::runRecord(program, estimator, 16);
    r.time = time;
    r.maxDepth = 50;
    r.renderSeconds = 1;
    r.samplesPerSecond = 1024;
    return r;
}

class RunBoardTest : public testing::Test {
  protected:
    void SetUp() override {
        for (const app::RunRecord& record : {oldCpu_, oldGpu_, cpu_, gpu_, elsewhere_}) history_.append(record);
        board_.update(history_, "a");
    }
    bool isShown(const app::RunRecord& record) const {
        const std::vector<app::RunRecord> shown = board_.shown();
        return std::find(shown.begin(), shown.end(), record) != shown.end();
    }
    void select(const app::RunRecord& record, bool isAdded) {
        board_.select(record, isAdded);
        board_.update(history_, "a");
    }

    const app::RunRecord oldCpu_ = run("ray-tracing-cpu", "bsdf", "2026-01-01T00:00:01Z"),
                         oldGpu_ = run("ray-tracing-gpu", "bsdf", "2026-01-01T00:00:02Z"),
                         cpu_ = run("ray-tracing-cpu", "mis", "2026-01-01T00:00:03Z"),
                         gpu_ = run("ray-tracing-gpu", "mis", "2026-01-01T00:00:04Z");
    const app::RunRecord elsewhere_ = [] {
        app::RunRecord r = run("ray-tracing-cpu", "mis", "2026-01-01T00:00:05Z");
        r.scene = "b";
        return r;
    }();
    app::RunHistory history_{""};
    RunBoard board_;
};

TEST_F(RunBoardTest, ShowsTheRunsOfOneSceneOrOfAll) {
    EXPECT_EQ(board_.shown(), (std::vector{gpu_, cpu_, oldGpu_, oldCpu_}));
    board_.update(history_, "");
    EXPECT_EQ(board_.shown().size(), 5u);
    EXPECT_TRUE(isShown(elsewhere_));
}

TEST_F(RunBoardTest, TheNewestOfEqualWorkAreComparedUnlessOthersAreSelected) {
    ASSERT_NE(board_.pair().cpu, nullptr);
    EXPECT_EQ(*board_.pair().cpu, cpu_);
    EXPECT_EQ(*board_.pair().gpu, gpu_);
    select(oldCpu_, false);
    EXPECT_EQ(*board_.pair().cpu, cpu_) << "one run alone is no pair";
    select(oldGpu_, true);
    EXPECT_EQ(*board_.pair().cpu, oldCpu_);
    EXPECT_EQ(*board_.pair().gpu, oldGpu_);
    select(cpu_, true); // not of the same work
    EXPECT_EQ(*board_.pair().cpu, oldCpu_);
}

TEST_F(RunBoardTest, AClickSelectsOneOrAlsoOneAndTheSameOnceMoreNone) {
    select(cpu_, false);
    select(gpu_, false);
    EXPECT_EQ(board_.selected(), std::vector{gpu_});
    select(cpu_, true);
    EXPECT_EQ(board_.selected(), (std::vector{gpu_, cpu_}));
    select(gpu_, true);
    EXPECT_EQ(board_.selected(), std::vector{cpu_});
    select(cpu_, false);
    EXPECT_TRUE(board_.selected().empty());
}

TEST_F(RunBoardTest, HiddenRunsComeBackWhenTheyAreWanted) {
    select(gpu_, false);
    select(cpu_, true);
    board_.hideSelected();
    board_.update(history_, "a");
    EXPECT_EQ(board_.shown(), (std::vector{oldGpu_, oldCpu_}));
    EXPECT_EQ(*board_.pair().cpu, oldCpu_) << "what is hidden is not compared";
    EXPECT_TRUE(board_.selected().empty());
    EXPECT_EQ(board_.hiddenCount(), 2u);
    board_.showHidden();
    board_.update(history_, "a");
    EXPECT_EQ(board_.shown().size(), 4u);
    EXPECT_EQ(board_.hiddenCount(), 0u);
}

TEST_F(RunBoardTest, FollowsTheHistory) {
    select(gpu_, false);
    history_.remove({gpu_});
    board_.update(history_, "a");
    EXPECT_FALSE(isShown(gpu_));
    EXPECT_TRUE(board_.selected().empty());
    EXPECT_EQ(*board_.pair().gpu, oldGpu_);
    const app::RunRecord fresh = run("ray-tracing-gpu", "mis", "2026-01-01T00:00:06Z");
    history_.append(fresh);
    board_.update(history_, "a");
    EXPECT_EQ(*board_.pair().gpu, fresh);
}

// A frame learns what the pointer was at in the frame before.
TEST_F(RunBoardTest, WhatIsPointedAtIsKnownForOneFrame) {
    board_.hover(cpu_);
    EXPECT_FALSE(board_.isHovered(cpu_));
    board_.update(history_, "a");
    EXPECT_TRUE(board_.isHovered(cpu_));
    EXPECT_FALSE(board_.isHovered(gpu_));
    board_.update(history_, "a");
    EXPECT_FALSE(board_.isHovered(cpu_));
}

} // namespace
} // namespace rt::gui
