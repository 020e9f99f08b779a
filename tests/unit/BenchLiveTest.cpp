// Frames of a camera that moves: which cameras, and what is said of each.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "Common/Bench/Live.h"
#include "tests/unit/FakeEngine.h"

namespace rt::bench {
namespace {

LiveRequest shortPath() {
    LiveRequest request;
    request.scene = "one-weekend-default";
    request.width = 16;
    request.frames = 3;
    request.framesAfter = 2;
    request.referenceSeconds = 1;
    return request;
}

TEST(BenchLive, TheCameraGoesAroundWhatItLooksAtAndIsBackAfterTheCut) {
    LiveRequest request = shortPath();
    request.degrees = 90;
    scene::CameraDesc first;
    first.lookFrom = {1, 5, 2};
    first.lookAt = {1, 5, 0};
    first.up = {0, 2, 0};
    EXPECT_EQ(cameraOfFrame(first, request, 0), first);
    const scene::CameraDesc second = cameraOfFrame(first, request, 1); // a quarter turn
    EXPECT_NEAR(second.lookFrom.x, 3, 1e-12);
    EXPECT_NEAR(second.lookFrom.y, 5, 1e-12);
    EXPECT_NEAR(second.lookFrom.z, 0, 1e-12);
    EXPECT_EQ(second.lookAt, first.lookAt);
    EXPECT_EQ(cameraOfFrame(first, request, 3), first);
    EXPECT_EQ(cameraOfFrame(first, request, 4), second);
}

// Of an engine whose pictures are a flat grey with noise, for any camera.
TEST(BenchLive, EveryFrameHasItsErrors) {
    Engines engines({{"multi", [](std::uint32_t) { return std::make_unique<app::FakeEngine>(); }, ""}});
    ReferenceStore store({}, false);
    const LiveRequest request = shortPath();
    const std::vector<LiveFrame> frames = measureLive(engines, store, request, app::kGoOn);
    ASSERT_EQ(frames.size(), 3u * 5);
    for (const LiveFrame& frame : frames) {
        ASSERT_TRUE(frame.relmse && frame.flip);
        EXPECT_GT(frame.seconds, 0);
        EXPECT_EQ(bool(frame.relmseLive), frame.spp > 1) << "one sample has no two halves";
        EXPECT_EQ(bool(frame.secondsFilter), frame.spp > 1);
        EXPECT_LT(frame.relmseLive.value_or(0), *frame.relmse);
    }
    EXPECT_FALSE(ghosting(request, frames, 1));
    EXPECT_GT(ghosting(request, frames, 4), 0.3); // nothing is remembered
    EXPECT_LT(ghosting(request, frames, 4), 3);
    const std::string text = toMarkdown(describeLive(request, frames), [](std::size_t) { return ""; });
    EXPECT_NE(text.find("3, cut"), std::string::npos) << text;
}

TEST(BenchLive, GhostingComparesTheFirstFrameAfterTheCutWithTheFirstOfAll) {
    LiveRequest request = shortPath();
    std::vector<LiveFrame> frames;
    for (const double error : {0.1, 0.05, 0.05, 0.4, 0.2}) {
        LiveFrame frame;
        frame.frame = static_cast<std::uint32_t>(frames.size());
        frame.spp = 2;
        frame.relmseLive = error;
        frames.push_back(frame);
    }
    EXPECT_DOUBLE_EQ(ghosting(request, frames, 2).value(), 4);
    EXPECT_FALSE(ghosting(request, frames, 1));
}

} // namespace
} // namespace rt::bench
