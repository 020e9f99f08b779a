// One render from its beginning to its end: limits, resuming, cancelling, checkpoints, and what a failure leaves.
#include <atomic>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "Common/App/Session/FilmRun.h"
#include "tests/unit/FakeEngine.h"

namespace rt::app {
namespace {

RenderSettings settings(std::uint32_t spp) {
    RenderSettings result;
    result.width = 20;
    result.height = 12;
    result.spp = spp;
    return result;
}

TEST(FilmRun, EndsWithTheLastSample) {
    FakeEngine engine;
    FilmRun run(engine, {}, settings(3));
    EXPECT_EQ(run.status().samplesTotal, 3u * 240);
    EXPECT_EQ(run.slice(1, kGoOn), std::nullopt);
    EXPECT_EQ(run.untilStopped(kGoOn), StopReason::Spp);
    EXPECT_EQ(engine.film().minSamples(), 3u);
    EXPECT_EQ(run.progress().samplesDone, 3u * 240);
    EXPECT_GE(run.progress().seconds, run.seconds());
}

TEST(FilmRun, GoesOnFromAFilmAsIfNeverStopped) {
    FakeEngine whole, first, second;
    FilmRun(whole, {}, settings(9)).untilStopped(kGoOn);
    FilmRun(first, {}, settings(4)).untilStopped(kGoOn);
    FilmRun rest(second, {}, settings(9), first.film());
    EXPECT_EQ(rest.samplesRestored(), 4u * 240);
    EXPECT_EQ(rest.status().samplesDone, 4u * 240);
    EXPECT_EQ(rest.untilStopped(kGoOn), StopReason::Spp);
    EXPECT_EQ(second.calls, 5u);
    EXPECT_EQ(second.film().resolve().data, whole.film().resolve().data);
}

TEST(FilmRun, TakesMoreSamplesAsIfTheyHadBeenAskedForAtFirst) {
    FakeEngine whole, engine;
    FilmRun(whole, {}, settings(40)).untilStopped(kGoOn);
    FilmRun run(engine, {}, settings(20));
    run.untilStopped(kGoOn);
    const double seconds = run.seconds();
    EXPECT_FALSE(run.canTake(19));
    ASSERT_TRUE(run.canTake(40));
    run.setSpp(40);
    EXPECT_FALSE(run.status().finished);
    EXPECT_EQ(run.status().samplesDone, 20u * 240);
    EXPECT_EQ(run.untilStopped(kGoOn), StopReason::Spp);
    EXPECT_EQ(engine.calls, 40u);
    EXPECT_EQ(engine.film().resolve().data, whole.film().resolve().data);
    EXPECT_GT(run.seconds(), seconds);
    EXPECT_EQ(run.report().rays.camera, 2 * engine.report().rays.camera); // of both parts
}

TEST(FilmRun, StrataAndPlansTakeNoOtherNumberOfSamples) {
    FakeEngine engine;
    RenderSettings strata = settings(20), plan = settings(64);
    strata.sampler = SamplerKind::Stratified;
    EXPECT_FALSE(FilmRun(engine, {}, strata).canTake(40));
    EXPECT_TRUE(FilmRun(engine, {}, strata).canTake(20));
    strata.sppIsKnown = false; // they come in rounds
    EXPECT_TRUE(FilmRun(engine, {}, strata).canTake(40));
    plan.adaptive = true;
    EXPECT_FALSE(FilmRun(engine, {}, plan).canTake(128));
}

TEST(FilmRun, CancellingKeepsTheFilmAndItMayGoOn) {
    FakeEngine engine;
    std::atomic<bool> cancel{false};
    engine.onSample = [&](std::uint32_t spp) { cancel = spp == 2; };
    FilmRun run(engine, {}, settings(5));
    EXPECT_EQ(run.untilStopped(cancel), StopReason::Interrupted);
    EXPECT_EQ(engine.film().minSamples(), 2u);
    EXPECT_EQ(run.untilStopped(kGoOn), StopReason::Spp);
}

// The time between two slices does not count: a window's film may rest.
TEST(FilmRun, TheTimeLimitIsThatOfSlicesAndCanBeGivenAnew) {
    FakeEngine engine;
    FilmRun run(engine, {}, settings(100'000'000));
    run.limit({.seconds = 1e6});
    EXPECT_EQ(run.slice(1, kGoOn), std::nullopt);
    const double before = run.progress().seconds;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_EQ(run.progress().seconds, before);
    EXPECT_EQ(run.progress().timeLimit, 1e6);
    run.limit({.seconds = 0.02}); // from now on
    EXPECT_EQ(run.untilStopped(kGoOn), StopReason::TimeLimit);
    EXPECT_GE(run.progress().seconds, before + 0.02);
    EXPECT_EQ(run.slice(1, kGoOn), StopReason::TimeLimit);
    run.limit({.seconds = 1e6});
    EXPECT_EQ(run.slice(1, kGoOn), std::nullopt);
}

TEST(FilmRun, TheEngineIsAskedForNoMoreTimeThanIsLeft) {
    class AskedEngine : public FakeEngine {
      public:
        RenderStatus renderSome(const Budget& budget) override {
            asked = budget.time.count();
            return FakeEngine::renderSome(budget);
        }
        double asked = 0;
    } engine;
    FilmRun run(engine, {}, settings(100));
    run.slice(0.2, kGoOn);
    EXPECT_EQ(engine.asked, 0.2);
    run.limit({.seconds = 0.1});
    run.slice(0.2, kGoOn);
    EXPECT_NEAR(engine.asked, 0.1, 1e-9);
    run.slice(0.2, kGoOn);
    EXPECT_LT(engine.asked, 0.1); // some of it is spent
}

TEST(FilmRun, StopsAtTheTargetErrorAndNotBefore) {
    FakeEngine engine;
    RenderSettings wanted = settings(1'000'000);
    wanted.replicates = 4;
    FilmRun run(engine, {}, wanted);
    run.limit({.targetError = 0.005}); // 1/12 / n / (1/4 + 0.01) at n = 64; see SessionTest for what comes on top
    EXPECT_EQ(run.untilStopped(kGoOn), StopReason::TargetError);
    const auto samples = static_cast<double>(engine.film().minSamples());
    EXPECT_GT(samples, 64);
    EXPECT_LT(samples, 64 * 1.16 * 1.1 * 1.1 * 1.1);
}

TEST(FilmRun, SavesBetweenSlicesAsOftenAsAsked) {
    FakeEngine engine;
    int saves = 0;
    FilmRun run(engine, {}, settings(6));
    run.limit({.saveEvery = 1e-9, .save = [&] { ++saves; }});
    run.untilStopped(kGoOn);
    EXPECT_EQ(saves, 5); // not after the last
    FilmRun seldom(engine, {}, settings(6));
    seldom.limit({.saveEvery = 1000, .save = [&] { ++saves; }});
    seldom.untilStopped(kGoOn);
    EXPECT_EQ(saves, 5);
}

TEST(FilmRun, AFailureKeepsWhatHadBeenCommitted) {
    FakeEngine engine;
    engine.onSample = [](std::uint32_t spp) {
        if (spp == 3) throw RenderError("the device was lost");
    };
    FilmRun run(engine, {}, settings(9));
    EXPECT_THROW(run.untilStopped(kGoOn), RenderError);
    EXPECT_EQ(run.status().samplesDone, 2u * 240); // as was told last
    engine.filmFails = true;
    std::string lost;
    EXPECT_EQ(run.keptFilm(lost).minSamples(), 3u);
    EXPECT_EQ(lost, "the film cannot be read");
}

} // namespace
} // namespace rt::app
