// When a run stops by its error.
#include <atomic>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Session/FilmRun.h"
#include "tests/unit/FakeEngine.h"

namespace rt::app {
namespace {

constexpr std::uint32_t kSpp = 400;

// Its film has noise until it has so many samples, and none from then on, or for one of them only.
class LuckyEngine : public FakeEngine {
  public:
    LuckyEngine(std::uint32_t quietFrom, bool quietOnce) : quietFrom_(quietFrom), quietOnce_(quietOnce) {}

    void reset(const scene::CameraDesc& camera, const RenderSettings& settings) override {
        FakeEngine::reset(camera, settings);
        quiet_ = image::Film({settings.width, settings.height, settings.replicates});
        quiet_.reserveOpenBlocks();
    }
    const image::Film& film() override {
        const image::Film& noisy = FakeEngine::film();
        const std::uint64_t samples = noisy.minSamples();
        if (samples < quietFrom_ || (quietOnce_ && samples > quietFrom_)) return noisy;
        for (std::uint32_t r = 0; r < noisy.desc().replicates; ++r) { // one tile
            const std::vector<double> sums(image::Film::kTilePixels * 3, double(noisy.samples(0, r)));
            const std::vector<float> open(sums.size(), 0.0f);
            quiet_.assign(0, r, {noisy.samples(0, r), sums, {}, open});
        }
        ++quietLooks;
        return quiet_;
    }
    int quietLooks = 0;

  private:
    std::uint32_t quietFrom_;
    bool quietOnce_;
    image::Film quiet_;
};

struct Outcome {
    StopReason stoppedBy;
    std::uint64_t samples; // over the 64 pixels
};

Outcome renderToTarget(LuckyEngine& engine) {
    RenderSettings settings;
    settings.width = settings.height = 8;
    settings.spp = kSpp;
    settings.replicates = 4;
    FilmRun run(engine, {}, settings);
    run.limit({.targetError = 1e-6});
    const StopReason reason = run.untilStopped(std::atomic<bool>(false));
    return {reason, run.status().samplesDone};
}

TEST(TargetError, OneLuckyLookDoesNotStop) {
    // Looks come at every sample at first, later at every tenth part more.
    bool looked = false;
    for (std::uint32_t lucky = 16; lucky < 40; ++lucky) {
        LuckyEngine engine(lucky, true);
        EXPECT_EQ(renderToTarget(engine).stoppedBy, StopReason::Spp) << lucky;
        looked = looked || engine.quietLooks > 0;
    }
    EXPECT_TRUE(looked);
}

TEST(TargetError, TheSecondLookStops) {
    LuckyEngine engine(50, false);
    const Outcome result = renderToTarget(engine);
    EXPECT_EQ(result.stoppedBy, StopReason::TargetError);
    EXPECT_EQ(engine.quietLooks, 2);
    EXPECT_LE(result.samples, 64u * 50 * 1.22);
}

TEST(TargetError, FewerThanFourSamplesOfAReplicateSayNothing) {
    LuckyEngine engine(1, false);
    EXPECT_GE(renderToTarget(engine).samples, 64u * 17);
}

} // namespace
} // namespace rt::app
