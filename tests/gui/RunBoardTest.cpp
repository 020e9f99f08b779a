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
        board_.update(history_, "a", view_);
    }
    bool isShown(const app::RunRecord& record) const {
        const std::vector<app::RunRecord> shown = board_.shown();
        return std::find(shown.begin(), shown.end(), record) != shown.end();
    }
    void look(const app::RunRecord& work) {
        view_.picture = work;
        board_.update(history_, "a", view_);
    }
    void select(const app::RunRecord& record, bool isAdded) {
        board_.select(record, isAdded);
        board_.update(history_, "a", view_);
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
    RunBoard::InView view_{cpu_, {}};
};

TEST_F(RunBoardTest, ShowsTheRunsOfOneSceneOrOfAll) {
    EXPECT_EQ(board_.shown(), (std::vector{gpu_, cpu_, oldGpu_, oldCpu_}));
    board_.update(history_, "", view_);
    EXPECT_EQ(board_.shown().size(), 5u);
    EXPECT_TRUE(isShown(elsewhere_));
}

TEST_F(RunBoardTest, RunsOfWhatIsInViewAreComparedUnlessOthersAreSelected) {
    ASSERT_NE(board_.pair().first, nullptr);
    EXPECT_EQ(*board_.pair().first, cpu_);
    EXPECT_EQ(*board_.pair().second, gpu_);
    look(oldCpu_); // another estimator is chosen
    EXPECT_EQ(*board_.pair().first, oldCpu_);
    EXPECT_EQ(*board_.pair().second, oldGpu_);
    app::RunRecord fresh = cpu_;
    fresh.sampler = "independent";
    look(fresh); // which has no run yet
    EXPECT_EQ(board_.pair().first, nullptr);
    EXPECT_EQ(board_.cpuRun(), nullptr);
    select(oldCpu_, false);
    EXPECT_EQ(board_.pair().first, nullptr) << "one run alone is no pair";
    select(oldGpu_, true);
    EXPECT_EQ(*board_.pair().first, oldCpu_);
    EXPECT_EQ(*board_.pair().second, oldGpu_);
    board_.clearSelection();
    look(fresh);
    EXPECT_EQ(board_.pair().first, nullptr);
}

// Of one program and of other work: who selects them knows why. The older one is the baseline.
TEST_F(RunBoardTest, AnyTwoThatAreSelectedAreCompared) {
    select(cpu_, false);
    select(oldCpu_, true);
    EXPECT_EQ(*board_.pair().first, oldCpu_);
    EXPECT_EQ(*board_.pair().second, cpu_);
    select(oldGpu_, true); // of three, those of equal work
    EXPECT_EQ(*board_.pair().first, oldCpu_);
    EXPECT_EQ(*board_.pair().second, oldGpu_);
}

TEST_F(RunBoardTest, APinnedPictureIsComparedWithTheOneBesideIt) {
    view_.pinned = oldCpu_;
    look(cpu_);
    EXPECT_EQ(*board_.pair().first, oldCpu_);
    EXPECT_EQ(*board_.pair().second, cpu_);
    view_.pinned.reset();
    look(cpu_);
    EXPECT_EQ(*board_.pair().second, gpu_);
}

TEST_F(RunBoardTest, OneProgramsRunAloneIsShownButNoPair) {
    history_.remove({gpu_});
    look(cpu_);
    EXPECT_EQ(board_.pair().first, nullptr);
    ASSERT_NE(board_.cpuRun(), nullptr);
    EXPECT_EQ(*board_.cpuRun(), cpu_);
    EXPECT_EQ(board_.gpuRun(), nullptr);
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
    board_.update(history_, "a", view_);
    EXPECT_EQ(board_.shown(), (std::vector{oldGpu_, oldCpu_}));
    EXPECT_EQ(board_.pair().first, nullptr) << "what is hidden is not compared";
    EXPECT_TRUE(board_.selected().empty());
    EXPECT_EQ(board_.hiddenCount(), 2u);
    board_.showHidden();
    board_.update(history_, "a", view_);
    EXPECT_EQ(board_.shown().size(), 4u);
    EXPECT_EQ(board_.hiddenCount(), 0u);
}

TEST_F(RunBoardTest, FollowsTheHistory) {
    select(gpu_, false);
    history_.remove({gpu_});
    board_.update(history_, "a", view_);
    EXPECT_FALSE(isShown(gpu_));
    EXPECT_TRUE(board_.selected().empty());
    EXPECT_EQ(board_.pair().first, nullptr);
    const app::RunRecord fresh = run("ray-tracing-gpu", "mis", "2026-01-01T00:00:06Z");
    history_.append(fresh);
    board_.update(history_, "a", view_);
    EXPECT_EQ(*board_.pair().second, fresh);
}

// A frame learns what the pointer was at in the frame before.
TEST_F(RunBoardTest, WhatIsPointedAtIsKnownForOneFrame) {
    board_.hover(cpu_);
    EXPECT_FALSE(board_.isHovered(cpu_));
    board_.update(history_, "a", view_);
    EXPECT_TRUE(board_.isHovered(cpu_));
    EXPECT_FALSE(board_.isHovered(gpu_));
    board_.update(history_, "a", view_);
    EXPECT_FALSE(board_.isHovered(cpu_));
}

} // namespace
} // namespace rt::gui
