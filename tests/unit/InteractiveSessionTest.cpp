// The session of a window with an engine whose samples cost nothing, without any window.
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/InteractiveSession.h"
#include "Common/Core/Error.h"
#include "Common/Image/ImageIo.h"
#include "tests/TempFolder.h"
#include "tests/unit/FakeEngine.h"

namespace rt::app {
namespace {

using namespace std::chrono_literals;

// Takes its time for a sample, and gives up when told to.
class SlowEngine : public FakeEngine {
  public:
    inline static std::atomic<int> films{0}; // begun

    RenderStatus renderSome(const Budget& budget) override {
        const auto end = std::chrono::steady_clock::now() + 5ms;
        while (std::chrono::steady_clock::now() < end) {
            if (budget.cancel != nullptr && budget.cancel->load()) {
                RenderStatus status = last_;
                return status;
            }
            std::this_thread::sleep_for(1ms);
        }
        return last_ = FakeEngine::renderSome(budget);
    }
    void reset(const scene::CameraDesc& camera, const RenderSettings& settings) override {
        FakeEngine::reset(camera, settings);
        ++films;
        last_ = {};
        last_.samplesTotal = std::uint64_t{settings.width} * settings.height * settings.spp;
    }

  private:
    RenderStatus last_;
};

class FailingEngine : public FakeEngine {
  public:
    RenderStatus renderSome(const Budget&) override { throw RenderError("the device was lost"); }
};

class InteractiveSessionTest : public ::testing::Test {
  protected:
    static InteractiveSession::Setup setup(std::uint32_t spp) {
        InteractiveSession::Setup setup;
        setup.options.program = "ray-tracing-cpu";
        setup.makeEngine = [](const EngineChoice&) { return std::make_unique<SlowEngine>(); };
        setup.request.size.width = 24;
        setup.request.settings.spp = spp;
        setup.scene = {"cornell-box-lights", true};
        return setup;
    }
    // Waits until the state is as wanted; the time only ends a test that fails.
    template <class Condition>
    static bool reaches(const InteractiveSession& session, Condition condition) {
        for (int i = 0; i < 20'000; ++i) {
            if (condition(session.state())) return true;
            std::this_thread::sleep_for(1ms);
        }
        return false;
    }
    static bool isFinished(const SessionState& state) { return state.activity == Activity::Finished; }

    test::TempFolder folder_;
};

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

TEST_F(InteractiveSessionTest, ASceneThatCannotBeLoadedLeavesTheOldOne) {
    InteractiveSession session(setup(4));
    ASSERT_TRUE(reaches(session, isFinished));
    const auto scene = session.state().scene;
    std::ofstream(folder_ / "bad.json") << "{\"camera\": 12";
    session.open((folder_ / "bad.json").string());
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.errorSerial == 1; }));
    EXPECT_NE(session.state().error.find("bad.json"), std::string::npos);
    EXPECT_EQ(session.state().scene, scene);
    EXPECT_FALSE(session.state().fatal);
    session.open("no-such-scene");
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.errorSerial == 2; }));
    EXPECT_EQ(session.state().scene, scene);
    session.open("one-weekend-default");
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.sceneSerial == 2 && isFinished(s); }));
    EXPECT_EQ(session.state().scene->id, "one-weekend-default");
    EXPECT_EQ(session.state().source, "one-weekend-default");
}

TEST_F(InteractiveSessionTest, WhatCannotStartIsFatal) {
    InteractiveSession::Setup wrong = setup(4);
    wrong.scene.source = "no-such-scene";
    const InteractiveSession session(wrong);
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.fatal != nullptr; }));
    EXPECT_THROW(std::rethrow_exception(session.state().fatal), InputError);

    InteractiveSession::Setup noEngine = setup(4);
    noEngine.makeEngine = [](const EngineChoice&) -> std::unique_ptr<Engine> { throw RenderError("no device"); };
    const InteractiveSession other(noEngine);
    ASSERT_TRUE(reaches(other, [](const SessionState& s) { return s.fatal != nullptr; }));
}

TEST_F(InteractiveSessionTest, AnEngineThatFailsIsReplacedWhenItIsNeededAgain) {
    InteractiveSession::Setup s = setup(4);
    int made = 0;
    s.makeEngine = [&made](const EngineChoice&) -> std::unique_ptr<Engine> {
        if (++made == 1) return std::make_unique<FailingEngine>();
        return std::make_unique<FakeEngine>();
    };
    InteractiveSession session(s);
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.activity == Activity::Failed; }));
    EXPECT_EQ(session.state().error, "the device was lost");
    session.render();
    EXPECT_TRUE(reaches(session, isFinished));
    EXPECT_EQ(made, 2);
}

TEST_F(InteractiveSessionTest, AnEngineThatCannotBeHadLeavesTheOneBeforeAtWork) {
    // Has no pipeline for the film: that comes to light before the engine is exchanged.
    class NoPipelineEngine : public FakeEngine {
        void reset(const scene::CameraDesc&, const RenderSettings&) override { throw RenderError("no pipeline"); }
    };
    InteractiveSession::Setup s = setup(1'000'000);
    int made = 0;
    s.makeEngine = [&made](const EngineChoice& choice) -> std::unique_ptr<Engine> {
        ++made;
        if (choice.device == "missing") throw RenderError("no such device");
        if (choice.kind == GpuEngineKind::Pipeline) return std::make_unique<NoPipelineEngine>();
        return std::make_unique<SlowEngine>();
    };
    InteractiveSession session(s);
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.status.samplesDone > 0; }));
    const std::uint64_t before = session.state().status.samplesDone;
    EngineChoice choice;
    choice.device = "missing";
    session.choose(choice);
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.engineFailures == 1; }));
    choice = {};
    choice.kind = GpuEngineKind::Pipeline;
    session.choose(choice);
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.engineFailures == 2; }));
    EXPECT_EQ(session.state().error, "no pipeline");
    EXPECT_EQ(session.state().engine, EngineChoice());
    EXPECT_GE(session.state().status.samplesDone, before); // the film went on
    EXPECT_TRUE(reaches(session, [&](const SessionState& state) {
        return state.activity == Activity::Rendering && state.status.samplesDone > before;
    }));
    session.choose({}); // is at work already
    choice.kind = GpuEngineKind::Compute;
    session.choose(choice);
    ASSERT_TRUE(reaches(session, [&](const SessionState& state) { return state.engine == choice; }));
    EXPECT_EQ(made, 4);
}

// Draws a grey that tells from where.
class DrawingEngine : public SlowEngine {
  public:
    inline static std::atomic<int> drawn{0};
    bool canPreview() const override { return true; }
    Preview renderPreview(const scene::CameraDesc& camera, std::uint32_t width, std::uint32_t height) override {
        ++drawn;
        Preview preview{image::Image(width, height, 3), image::Image(width, height, 1)};
        preview.picture.data.assign(preview.picture.data.size(), static_cast<float>(camera.lookFrom.x));
        preview.depth.data.assign(preview.depth.data.size(), 8.0f);
        return preview;
    }
};

TEST_F(InteractiveSessionTest, ThePreviewLeavesTheFilmAsItIsAndRaysRest) {
    InteractiveSession::Setup s = setup(1'000'000);
    s.makeEngine = [](const EngineChoice&) { return std::make_unique<DrawingEngine>(); };
    InteractiveSession session(s);
    const auto isPreview = [](const SessionState& state) { return state.picture.isPreview; };
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.picture.spp > 0; }));
    EXPECT_TRUE(session.state().canPreview);
    session.preview(true);
    ASSERT_TRUE(reaches(session, isPreview));
    const SessionState before = session.state();
    const int films = SlowEngine::films, drawn = DrawingEngine::drawn;
    EXPECT_EQ(before.picture.image->width, 24u);
    EXPECT_EQ(before.picture.image->data[0], static_cast<float>(before.scene->camera.lookFrom.x));
    std::this_thread::sleep_for(30ms);
    session.pause(); // rests already
    session.pickFocus(12, 12);
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.focusSerial == 1; }));
    EXPECT_EQ(session.state().picture.serial, before.picture.serial); // neither drawn again nor rendered on
    session.save({.files = {(folder_ / "preview.exr").string()}});
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.messageSerial == 1; }));
    EXPECT_EQ(image::readImage((folder_ / "preview.exr").string()).data, before.picture.image->data);
    session.renderReference(4);
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.errorSerial == 1; }));

    session.preview(false); // the film goes on
    ASSERT_TRUE(reaches(session, [&](const SessionState& state) {
        return !state.picture.isPreview && state.picture.spp > before.status.samplesDone / (24 * 24);
    }));
    EXPECT_EQ(SlowEngine::films, films);
    EXPECT_EQ(DrawingEngine::drawn, drawn);

    session.preview(true);
    ASSERT_TRUE(reaches(session, isPreview));
    scene::CameraDesc camera = before.scene->camera;
    camera.lookFrom.x = 77;
    session.moveCamera(camera, before.sceneSerial);
    EXPECT_TRUE(reaches(session, [](const SessionState& state) { return state.picture.image->data[0] == 77; }));
    EXPECT_EQ(SlowEngine::films, films);
    session.preview(false); // another film
    EXPECT_TRUE(reaches(session, [](const SessionState& state) { return !state.picture.isPreview; }));
    EXPECT_TRUE(reaches(session, [](const SessionState& state) { return state.picture.spp > 0; }));
    EXPECT_GT(SlowEngine::films, films);
}

TEST_F(InteractiveSessionTest, APreviewFromTheBeginningNeedsNoRay) {
    InteractiveSession::Setup s = setup(4);
    s.makeEngine = [](const EngineChoice&) { return std::make_unique<DrawingEngine>(); };
    s.preview = true;
    const int films = SlowEngine::films;
    InteractiveSession session(s);
    EXPECT_TRUE(reaches(session, [](const SessionState& state) { return state.picture.isPreview; }));
    EXPECT_EQ(SlowEngine::films, films);
    EXPECT_EQ(session.state().settings.width, 24u);
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

TEST_F(InteractiveSessionTest, ARememberedSceneThatIsGoneGivesWayToAnother) {
    InteractiveSession::Setup with = setup(4);
    with.scene.source = (folder_ / "gone.json").string();
    with.fallbackScene = "one-weekend-default";
    InteractiveSession session(std::move(with));
    ASSERT_TRUE(reaches(session, isFinished));
    EXPECT_EQ(session.state().source, "one-weekend-default");
    EXPECT_NE(session.state().error.find("gone.json"), std::string::npos);
    EXPECT_EQ(session.state().fatal, nullptr);
}

TEST_F(InteractiveSessionTest, SavesWhatItShows) {
    InteractiveSession session(setup(4));
    ASSERT_TRUE(reaches(session, isFinished));
    const std::string exr = (folder_ / "a.exr").string();
    session.save({.files = {(folder_ / "a.png").string(), exr}});
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.messageSerial == 2; }));
    EXPECT_EQ(image::readImage(exr).data, session.state().picture.image->data);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "a.png"));
    session.save({.files = {(folder_ / "no/such/folder/a.png").string()}});
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.errorSerial == 1; }));
    EXPECT_EQ(session.state().activity, Activity::Finished);
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

// After the first picture one each half a second; without that it were twenty.
TEST_F(InteractiveSessionTest, PicturesThatTheProcessorDrawsAreFew) {
    InteractiveSession::Setup s = setup(160);
    s.drawnBySoftware = true;
    s.request.samplesPerFrame = 100'000;
    const Stopwatch watch;
    InteractiveSession session(s);
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.picture.spp > 0; }));
    ASSERT_TRUE(reaches(session, isFinished));
    EXPECT_GE(session.state().picture.serial, 2u); // the first and the last
    EXPECT_LE(static_cast<double>(session.state().picture.serial), 4 + 2 * watch.seconds());
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

TEST_F(InteractiveSessionTest, RunsThatEndGoIntoTheHistory) {
    RunHistory history(folder_ / "history.jsonl");
    InteractiveSession::Setup s = setup(20);
    s.history = &history;
    {
        InteractiveSession session(s);
        ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.historySerial == 1; }));
    }
    const std::vector<RunRecord>& records = history.records();
    ASSERT_EQ(records.size(), 1u);
    EXPECT_EQ(records[0].scene, "cornell-box-lights");
    EXPECT_EQ(records[0].spp, 20u);
    EXPECT_EQ(records[0].width, 24u);
    EXPECT_GT(records[0].renderSeconds, 0);
    EXPECT_GT(records[0].samplesPerSecond, 0);
}

TEST_F(InteractiveSessionTest, ErrorsAreTakenAgainstAReferenceOfTheSameView) {
    RunHistory history(folder_ / "history.jsonl");
    InteractiveSession::Setup s = setup(20);
    s.history = &history;
    InteractiveSession session(s);
    ASSERT_TRUE(reaches(session, isFinished));
    session.renderReference(40);
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return isFinished(state) && state.referenceFits; }));
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return !state.curve.empty(); }));
    const SessionState state = session.state();
    EXPECT_FALSE(state.isReferenceRender);
    EXPECT_EQ(state.settings.spp, 20u);
    EXPECT_EQ(state.curve.back().spp, 20);
    EXPECT_GT(state.curve.back().relmse, 0);
    ASSERT_TRUE(
        reaches(session, [](const SessionState& st) { return st.historySerial == 2; })); // the reference is no run
    EXPECT_TRUE(history.records().back().hasReference);
    EXPECT_EQ(history.records().back().relmse, state.curve.back().relmse);

    scene::CameraDesc camera = state.scene->camera;
    camera.verticalFov += 1;
    session.moveCamera(camera, state.sceneSerial);
    EXPECT_TRUE(reaches(
        session, [](const SessionState& st) { return isFinished(st) && !st.referenceFits && st.curve.empty(); }));
    session.moveCamera(state.scene->camera, state.sceneSerial); // back to what the reference shows
    EXPECT_TRUE(reaches(session, [](const SessionState& st) { return isFinished(st) && st.referenceFits; }));
}

TEST_F(InteractiveSessionTest, ReferencesAreReadFromLinearFilesOfTheSameSize) {
    InteractiveSession session(setup(4));
    ASSERT_TRUE(reaches(session, isFinished));
    image::writeImage(folder_ / "right.pfm", image::Image(24, 24));
    image::writeImage(folder_ / "wrong.pfm", image::Image(25, 24));
    session.loadReference((folder_ / "wrong.pfm").string());
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.errorSerial == 1; }));
    EXPECT_NE(session.state().error.find("25x24"), std::string::npos);
    EXPECT_TRUE(session.state().reference.empty());
    session.loadReference((folder_ / "right.pfm").string());
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.referenceFits && !s.curve.empty(); }));
}

TEST_F(InteractiveSessionTest, StopGivesAReferenceUp) {
    InteractiveSession session(setup(4));
    ASSERT_TRUE(reaches(session, isFinished));
    session.renderReference(1'000'000);
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.isReferenceRender; }));
    session.stop();
    EXPECT_TRUE(reaches(session, [](const SessionState& s) { return isFinished(s) && !s.isReferenceRender; }));
    EXPECT_TRUE(session.state().reference.empty());
    EXPECT_EQ(session.state().settings.spp, 4u);
}

TEST_F(InteractiveSessionTest, ShowsFeaturesAndWhatAPixelHolds) {
    InteractiveSession session(setup(20));
    ASSERT_TRUE(reaches(session, isFinished));
    EXPECT_FALSE(session.state().picture.isDisplay);
    session.view({ViewMode::Albedo, 1, true});
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.picture.isDisplay; }));
    SessionState state = session.state();
    EXPECT_EQ(state.picture.image->data, std::vector<float>(24 * 24 * 3, 0.25f)); // of the fake engine
    EXPECT_NE(state.picture.radiance->data, state.picture.image->data);
    ASSERT_TRUE(state.picture.samples && state.picture.variance);
    EXPECT_EQ(state.picture.samples->data, std::vector<float>(24 * 24, 20.0f));
    session.view({ViewMode::Noise, 1, false});
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return !s.picture.samples; }));
    EXPECT_TRUE(session.state().picture.isDisplay);
    session.view({ViewMode::Error, 1, false}); // without a reference it is the picture
    EXPECT_TRUE(reaches(session, [](const SessionState& s) { return !s.picture.isDisplay; }));
    EXPECT_EQ(session.state().activity, Activity::Finished); // a view renders nothing anew
}

TEST_F(InteractiveSessionTest, FocusIsThePlaneThroughWhatIsSeen) {
    InteractiveSession session(setup(4));
    ASSERT_TRUE(reaches(session, isFinished));
    session.pickFocus(0, 12);
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.focusSerial == 1; }));
    const double half = std::tan(0.5 * session.state().scene->camera.verticalFov * 3.14159265358979323846 / 180);
    const double right = half * (1.0 / 24 - 1), up = half * (25.0 / 24 - 1);
    EXPECT_NEAR(session.state().focusDistance, 8 / std::sqrt(1 + right * right + up * up), 1e-6);
    session.pickFocus(1000, 1000); // outside: nothing
    session.save({.files = {(folder_ / "a.png").string()}});
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.messageSerial == 1; }));
    EXPECT_EQ(session.state().focusSerial, 1u);
}

} // namespace
} // namespace rt::app
