// What a render says of itself, and how often.
#include <algorithm>
#include <sstream>

#include <gtest/gtest.h>

#include "Common/Render/Progress.h"

namespace rt::app {
namespace {

ProgressState stateAt(double seconds) {
    ProgressState state;
    state.pixels = 1000;
    state.samplesTotal = 100'000;
    state.samplesDone = static_cast<std::uint64_t>(seconds * 1000);
    state.seconds = seconds;
    return state;
}

long lines(const std::string& text) {
    return std::count(text.begin(), text.end(), '\n');
}

TEST(Progress, NamesSamplesPercentRateAndTimeLeft) {
    EXPECT_EQ(describeProgress(stateAt(37.5)), "37/100 spp  37%  1.0 k samples/s  1:03 left");
    ProgressState fast = stateAt(37.5);
    fast.seconds = 0.01;
    EXPECT_EQ(describeProgress(fast), "37/100 spp  37%  3.75 M samples/s  0:01 left");
    ProgressState slow = stateAt(1);
    slow.seconds = 1000;
    EXPECT_EQ(describeProgress(slow), "1/100 spp  1%  0.0 k samples/s  27:30:00 left");
    EXPECT_EQ(describeProgress(stateAt(0)), "0/100 spp  0%");
}

TEST(Progress, TimeLimitBoundsTheTimeLeft) {
    ProgressState state = stateAt(20);
    state.timeLimit = 30;
    EXPECT_NE(describeProgress(state).find("0:10 left"), std::string::npos);
}

TEST(Progress, RestoredSamplesTookNoTime) {
    ProgressState state = stateAt(60);
    state.samplesRestored = 40'000;
    state.seconds = 20;
    EXPECT_EQ(describeProgress(state), "60/100 spp  60%  1.0 k samples/s  0:40 left");
}

TEST(Progress, TerminalLineIsRewrittenAtMostFiveTimesASecond) {
    std::ostringstream out;
    Progress progress(out, Progress::Style::Terminal);
    for (int i = 1; i <= 1000; ++i) progress.update(stateAt(i * 0.01));
    const std::string text = out.str();
    EXPECT_GE(std::count(text.begin(), text.end(), '\r'), 45);
    EXPECT_LE(std::count(text.begin(), text.end(), '\r'), 51);
    EXPECT_EQ(lines(text), 0);
    EXPECT_EQ(text.find('\033'), std::string::npos);
    progress.finish(stateAt(10), "done");
    EXPECT_EQ(lines(out.str()), 1);
    EXPECT_NE(out.str().find("\r10 spp in 10.00 s  1.0 k samples/s  done"), std::string::npos);
}

TEST(Progress, ShorterLinesCoverLongerOnes) {
    std::ostringstream out;
    Progress progress(out, Progress::Style::Terminal);
    progress.update(stateAt(1));
    const std::size_t length = out.str().size();
    progress.finish(stateAt(1), "");
    EXPECT_GE(out.str().size(), 2 * length); // padded, and a line feed
}

TEST(Progress, ElsewhereALineEveryTenSeconds) {
    std::ostringstream out;
    Progress progress(out, Progress::Style::Lines);
    for (int i = 1; i < 1000; ++i) progress.update(stateAt(i * 0.05));
    EXPECT_EQ(lines(out.str()), 4); // at 10, 20, 30 and 40 seconds
    EXPECT_EQ(out.str().find('\r'), std::string::npos);
}

TEST(Progress, SilentSaysNothing) {
    std::ostringstream out;
    Progress progress(out, Progress::Style::Silent);
    progress.update(stateAt(100));
    progress.finish(stateAt(100), "done");
    EXPECT_EQ(out.str(), "");
}

} // namespace
} // namespace rt::app
