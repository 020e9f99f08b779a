// Films of a window: begun, paused, ended, begun anew.
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "tests/unit/InteractiveFixture.h"

namespace rt::app {
namespace {

using namespace std::chrono_literals;

class InteractiveSessionTest : public InteractiveFixture {};

TEST_F(InteractiveSessionTest, RendersToTheEndAndShowsTheFilm) {
    InteractiveSession session(setup(20));
    ASSERT_TRUE(reaches(session, isFinished));
    const SessionState state = session.state();
    ASSERT_TRUE(state.picture.image);
    EXPECT_EQ(state.picture.image->width, 24u);
    EXPECT_EQ(state.picture.spp, 20u);
    EXPECT_EQ(state.status.samplesDone, 24u * 24 * 20);
    // As rendered without a window.
    FakeEngine engine;
    std::atomic<bool> cancel{false};
    RenderSettings settings = state.settings;
    engine.setScene(state.scene, &cancel);
    engine.reset(state.scene->camera, settings);
    while (!engine.renderSome({}).finished) continue;
    EXPECT_EQ(state.picture.image->data, engine.film().resolve().data);
    ASSERT_TRUE(state.lastRun);
    EXPECT_EQ(state.lastRun->spp, 20u);
    EXPECT_GT(state.lastRun->seconds.render, 0);
}

TEST_F(InteractiveSessionTest, PausesGoesOnAndStops) {
    InteractiveSession session(setup(1'000'000));
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.status.samplesDone > 0; }));
    session.pause();
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.activity == Activity::Paused; }));
    const std::uint64_t paused = session.state().status.samplesDone;
    EXPECT_GT(paused, 0u);
    std::this_thread::sleep_for(30ms);
    EXPECT_EQ(session.state().status.samplesDone, paused);
    session.render();
    EXPECT_TRUE(reaches(session, [&](const SessionState& s) { return s.status.samplesDone > paused; }));
    session.stop();
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.activity == Activity::Stopped; }));
    EXPECT_GE(session.state().status.samplesDone, paused);
    const int films = SlowEngine::films;
    session.render(); // from the beginning
    EXPECT_TRUE(reaches(session, [&](const SessionState&) { return SlowEngine::films > films; }));
}

// Even before there is anything to see: its engine does nothing but wait until it is told to give up.
TEST_F(InteractiveSessionTest, WhatHasNoPictureYetIsCancelledToo) {
    static std::atomic<int> waits{0};
    class WaitingEngine : public FakeEngine {
        RenderStatus renderSome(const Budget& budget) override {
            ++waits;
            while (!budget.cancel->load()) std::this_thread::sleep_for(1ms);
            return {};
        }
    };
    InteractiveSession::Setup s = setup(100);
    s.makeEngine = [](const EngineChoice&) { return std::make_unique<WaitingEngine>(); };
    InteractiveSession session(s);
    ASSERT_TRUE(reaches(session, [](const SessionState&) { return waits > 0; }));
    session.stop();
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.activity == Activity::Stopped; }));
    EXPECT_EQ(session.state().picture.serial, 0u);
    const int before = waits;
    session.render();
    ASSERT_TRUE(reaches(session, [before](const SessionState&) { return waits > before; }));
    EngineChoice choice;
    choice.threads = 2;
    session.choose(choice);
    EXPECT_TRUE(reaches(session, [&](const SessionState& state) { return state.engine == choice; }));
}

// White spheres are built for as long as they are wanted.
class BuildingEngine : public SlowEngine {
  public:
    inline static std::atomic<int> builds{0};

    bool setScene(std::shared_ptr<const scene::CompiledScene> scene, const std::atomic<bool>* cancel) override {
        const bool isEndless = scene->id.starts_with("white-spheres");
        builds += isEndless;
        while (isEndless && !cancel->load()) std::this_thread::sleep_for(1ms);
        return !isEndless && FakeEngine::setScene(std::move(scene), cancel);
    }
};

TEST_F(InteractiveSessionTest, TheNewestWishDoesNotWaitForABuildThatItReplaces) {
    InteractiveSession::Setup s = setup(1'000'000);
    s.makeEngine = [](const EngineChoice&) { return std::make_unique<BuildingEngine>(); };
    InteractiveSession session(s);
    const auto build = [&] {
        const int before = BuildingEngine::builds;
        session.open("white-spheres:2");
        return reaches(session, [before](const SessionState&) { return BuildingEngine::builds > before; });
    };
    ASSERT_TRUE(build());
    session.open("cornell-box-lights");
    ASSERT_TRUE(reaches(session, [](const SessionState& state) {
        return state.scene && state.scene->id == "cornell-box-lights" && state.activity == Activity::Rendering;
    }));
    // What is not replaced goes on after what came between.
    ASSERT_TRUE(build());
    const int before = BuildingEngine::builds;
    EngineChoice choice;
    choice.threads = 2;
    session.choose(choice);
    EXPECT_TRUE(reaches(session, [&](const SessionState& state) { return state.engine == choice; }));
    EXPECT_TRUE(reaches(session, [before](const SessionState&) { return BuildingEngine::builds > before; }));
    // Stop gives it up, and the scene before stays.
    session.stop();
    ASSERT_TRUE(reaches(
        session, [](const SessionState& state) { return state.activity == Activity::Stopped && state.stage.empty(); }));
    EXPECT_EQ(session.state().source, "cornell-box-lights");
    session.render();
    EXPECT_TRUE(reaches(session, [](const SessionState& state) { return state.status.samplesDone > 0; }));
    EXPECT_EQ(session.state().scene->id, "cornell-box-lights");
}

// A camera that rests in the middle of a drag shows a film to its end, which nobody asked for.
TEST_F(InteractiveSessionTest, FilmsThatEndWhileTheCameraIsHeldAreNoRuns) {
    InteractiveSession::Setup s = setup(4);
    RunHistory history({});
    s.history = &history;
    InteractiveSession session(s);
    ASSERT_TRUE(reaches(session, isFinished));
    EXPECT_EQ(history.records().size(), 1u);
    session.hold(true);
    scene::CameraDesc camera = session.state().scene->camera;
    const auto moveOn = [&] {
        camera.lookFrom.x += 1;
        const int films = SlowEngine::films;
        session.moveCamera(camera, session.state().sceneSerial);
        return reaches(session,
                       [films](const SessionState& state) { return SlowEngine::films > films && isFinished(state); });
    };
    ASSERT_TRUE(moveOn());
    ASSERT_TRUE(moveOn());
    EXPECT_EQ(history.records().size(), 1u);
    session.hold(false); // the last one is what the user wanted
    EXPECT_TRUE(reaches(session, [&](const SessionState& state) { return state.historySerial == 2; }));
    EXPECT_EQ(history.records().size(), 2u);
}

// The mouse counts as held until the frame in which its release has pressed the button is over.
TEST_F(InteractiveSessionTest, ARenderThatTheMouseStopsIsARun) {
    InteractiveSession::Setup s = setup(1u << 20);
    RunHistory history({});
    s.history = &history;
    InteractiveSession session(s);
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.picture.spp > 0; }));
    session.hold(true);
    for (int slice = 0; slice < 3; ++slice) { // it is known before the next request comes
        const std::uint64_t done = session.state().status.samplesDone;
        ASSERT_TRUE(reaches(session, [done](const SessionState& state) { return state.status.samplesDone > done; }));
    }
    session.stop();
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.activity == Activity::Stopped; }));
    EXPECT_EQ(history.records().size(), 0u);
    session.hold(false);
    EXPECT_TRUE(reaches(session, [](const SessionState& state) { return state.historySerial == 1; }));
    EXPECT_EQ(history.records().size(), 1u);
}

TEST_F(InteractiveSessionTest, StopGivesUpTheFirstSceneToo) {
    InteractiveSession::Setup s = setup(4);
    s.makeEngine = [](const EngineChoice&) { return std::make_unique<BuildingEngine>(); };
    s.scene.source = "white-spheres:2";
    const int before = BuildingEngine::builds;
    InteractiveSession session(s);
    ASSERT_TRUE(reaches(session, [before](const SessionState&) { return BuildingEngine::builds > before; }));
    session.stop();
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.activity == Activity::Stopped; }));
    session.open("cornell-box-lights");
    EXPECT_TRUE(reaches(session, isFinished));
}

TEST_F(InteractiveSessionTest, AChangeStartsTheFilmAnew) {
    InteractiveSession session(setup(8));
    ASSERT_TRUE(reaches(session, isFinished));
    RenderRequest request = setup(12).request;
    request.size = {40u, 20u, std::nullopt};
    request.settings.maxDepth = 7;
    session.change(request);
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return isFinished(s) && s.picture.spp == 12; }));
    const SessionState state = session.state();
    EXPECT_EQ(state.settings.maxDepth, 7u);
    EXPECT_EQ(state.picture.image->width, 40u);
    EXPECT_EQ(state.picture.image->height, 20u);
}

TEST_F(InteractiveSessionTest, MoreSamplesAndOtherBudgetsLeaveTheFilm) {
    InteractiveSession::Setup s = setup(8);
    RunHistory history({});
    s.history = &history;
    InteractiveSession session(s);
    ASSERT_TRUE(reaches(session, isFinished));
    const int films = SlowEngine::films, restored = SlowEngine::restored;
    s.request.settings.spp = 12;
    session.change(s.request);
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return isFinished(s) && s.picture.spp == 12; }));
    EXPECT_EQ(SlowEngine::films - films, 1);
    EXPECT_EQ(SlowEngine::restored - restored, 1);
    EXPECT_EQ(session.state().settings.spp, 12u);

    // The film has ended; one that was stopped goes on when told to.
    s.request.settings.spp = 1'000'000;
    session.change(s.request);
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.picture.spp > 16; }));
    session.stop();
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.activity == Activity::Stopped; }));
    const std::uint64_t samples = session.state().status.samplesDone;
    s.request.timeLimit = 1e-9; // is used up, and there is as much again
    session.change(s.request);
    session.goOn();
    ASSERT_TRUE(reaches(session, isFinished));
    EXPECT_GE(session.state().status.samplesDone, samples);
    EXPECT_EQ(SlowEngine::restored - restored, 2);

    s.request.settings.spp = 4; // fewer than there are
    s.request.timeLimit.reset();
    session.change(s.request);
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return isFinished(s) && s.picture.spp == 4; }));
    EXPECT_EQ(SlowEngine::restored - restored, 2);
    session.close();
    ASSERT_EQ(history.records().size(), 5u);
    EXPECT_EQ(history.records()[0].spp, 8u);
    EXPECT_EQ(history.records()[1].spp, 12u);
    EXPECT_GT(history.records()[1].renderSeconds, history.records()[0].renderSeconds);
    EXPECT_EQ(history.records().back().spp, 4u);
}

TEST_F(InteractiveSessionTest, ACameraOfAnotherSceneIsIgnored) {
    InteractiveSession session(setup(4));
    ASSERT_TRUE(reaches(session, isFinished));
    const std::uint64_t serial = session.state().picture.serial;
    scene::CameraDesc camera = session.state().scene->camera;
    camera.lookFrom.x += 1;
    session.moveCamera(camera, 7);
    session.stop(); // is obeyed after the camera
    std::this_thread::sleep_for(30ms);
    EXPECT_EQ(session.state().picture.serial, serial);
    session.moveCamera(camera, 1);
    EXPECT_TRUE(reaches(session, [&](const SessionState& s) { return isFinished(s) && s.picture.serial > serial; }));
}

// A file that changes while its user opens another one does not come back by that.
TEST_F(InteractiveSessionTest, AChangedFileGivesWayToWhatIsBeingOpened) {
    InteractiveSession session(setup(1));
    ASSERT_TRUE(reaches(session, isFinished));
    const std::string other = "white-spheres:200000"; // takes a while
    session.open(other);
    EXPECT_FALSE(session.reopen("cornell-box-lights"));
    ASSERT_TRUE(
        reaches(session, [&](const SessionState& s) { return s.source == other && isFinished(s) && s.stage.empty(); }));
    EXPECT_TRUE(session.reopen(other)) << session.state().stage;
    EXPECT_TRUE(reaches(session, [&](const SessionState& s) { return s.sceneLoads == 3 && isFinished(s); }));
}

// Takes a microsecond for each sample, and calls back when it has taken some.
class PacedEngine : public FakeEngine {
  public:
    explicit PacedEngine(std::function<void(const RenderSettings&)> onSamples) : onSamples_(std::move(onSamples)) {}

    void reset(const scene::CameraDesc& camera, const RenderSettings& settings) override {
        FakeEngine::reset(camera, settings);
        settings_ = settings;
    }
    RenderStatus renderSome(const Budget& budget) override {
        std::this_thread::sleep_for(std::chrono::microseconds(settings_.width * settings_.height));
        onSamples_(settings_);
        return FakeEngine::renderSome(budget);
    }

  private:
    std::function<void(const RenderSettings&)> onSamples_;
    RenderSettings settings_;
};

// The camera moves on whenever samples are taken, so that the next change waits at the end of every picture. With
// drafts no film is begun meanwhile; what else is asked for in between finds the film that belongs to the last draft.
TEST_F(InteractiveSessionTest, ACameraInMotionShowsPictures) {
    for (const std::uint32_t width : {24u, 400u}) {
        constexpr int kMoves = 64;
        std::atomic<InteractiveSession*> flying{nullptr};
        std::atomic<int> moves{0}, filmsInFlight{0};
        scene::CameraDesc camera;
        InteractiveSession::Setup s = setup(1'000'000);
        s.request.size.width = width;
        s.makeEngine = [&](const EngineChoice&) {
            return std::make_unique<PacedEngine>([&](const RenderSettings& settings) {
                InteractiveSession* session = flying;
                if (session == nullptr || moves == kMoves) return;
                if (moves > 0 && settings.width == width) ++filmsInFlight; // where no draft is needed it is one a move
                camera.lookFrom.x += 0.01;
                if (++moves == kMoves) return session->stop();
                session->moveCamera(camera, 1);
            });
        };
        InteractiveSession session(s);
        ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.picture.serial > 0; }));
        camera = session.state().scene->camera;
        const std::uint64_t serial = session.state().picture.serial;
        flying = &session;
        ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.activity == Activity::Stopped; }));
        EXPECT_GE(session.state().picture.serial, serial + kMoves / image::Film::kBlock - 1) << width;
        EXPECT_EQ(session.state().picture.image->width, width);
        if (width == 400) {
            EXPECT_LE(filmsInFlight, 1);
        }
    }
}

TEST_F(InteractiveSessionTest, LoopsAndFramesThatAreNotAccumulatedTakeOtherSeeds) {
    InteractiveSession::Setup s = setup(3);
    s.request.loop = true;
    InteractiveSession session(s);
    EXPECT_TRUE(reaches(session, [](const SessionState& state) { return state.settings.seed >= 2; }));
    RenderRequest request = s.request;
    request.loop = false;
    request.accumulate = false;
    request.samplesPerFrame = 2;
    session.change(request);
    EXPECT_TRUE(reaches(session,
                        [](const SessionState& state) { return state.settings.spp == 2 && state.settings.seed >= 3; }));
    session.stop();
    EXPECT_TRUE(reaches(session, [](const SessionState& state) { return state.activity == Activity::Stopped; }));
}

TEST_F(InteractiveSessionTest, HowOftenASumIsShownDoesNotConcernTheFilm) {
    RenderRequest before, after;
    after.samplesPerFrame = 0;
    EXPECT_FALSE(needsAnotherFilm(before, after));
    after.accumulate = false;
    EXPECT_TRUE(needsAnotherFilm(before, after));
    before.accumulate = false;
    EXPECT_TRUE(needsAnotherFilm(before, after));
    before.samplesPerFrame = 0;
    EXPECT_FALSE(needsAnotherFilm(before, after));

    InteractiveSession::Setup s = setup(1'000'000);
    InteractiveSession session(s);
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.picture.spp > 0; }));
    const int films = SlowEngine::films;
    for (const std::uint32_t samples : {0u, 1u, 100'000u}) {
        s.request.samplesPerFrame = samples;
        session.change(s.request);
        const std::uint64_t spp = session.state().picture.spp;
        // Also a frame that takes long is shown.
        EXPECT_TRUE(reaches(session, [&](const SessionState& state) { return state.picture.spp > spp; })) << samples;
    }
    EXPECT_EQ(SlowEngine::films, films);
}

// After the first picture one each half a second, whatever is asked; without that it were twenty.
TEST_F(InteractiveSessionTest, PicturesThatTheProcessorDrawsAreFew) {
    for (const std::uint32_t samplesPerFrame : {1u, 100'000u}) {
        InteractiveSession::Setup s = setup(160);
        s.drawnBySoftware = true;
        s.request.samplesPerFrame = samplesPerFrame;
        const Stopwatch watch;
        InteractiveSession session(s);
        ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.picture.spp > 0; }));
        ASSERT_TRUE(reaches(session, isFinished));
        EXPECT_GE(session.state().picture.serial, 2u); // the first and the last
        EXPECT_LE(static_cast<double>(session.state().picture.serial), 4 + 2 * watch.seconds());
    }
}

TEST_F(InteractiveSessionTest, FramesOfTheirOwnAreAsLargeAsThereIsTimeFor) {
    InteractiveSession::Setup s = setup(1'000'000);
    s.request.accumulate = false;
    s.request.samplesPerFrame = 0;
    InteractiveSession session(s);
    // 24 x 24 pixels at 5 ms a sample: more than one of them, and far fewer than a sum would have.
    EXPECT_TRUE(reaches(session, [](const SessionState& state) {
        return state.settings.seed >= 3 && state.settings.spp > 1 && state.settings.spp < 1000;
    })) << session.state().settings.spp;
}

} // namespace
} // namespace rt::app
