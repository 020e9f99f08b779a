// Scenes and engines that cannot be had, and engines that fail, in a window that goes on.
#include <fstream>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "Common/App/Session/FilmRun.h"
#include "Common/Core/Error.h"
#include "Common/Image/ImageIo.h"
#include "tests/FileBytes.h"
#include "tests/unit/InteractiveFixture.h"

namespace rt::app {
namespace {

class FailingEngine : public FakeEngine {
  public:
    RenderStatus renderSome(const Budget&) override { throw RenderError("the device was lost"); }
};

class InteractiveFailureTest : public InteractiveFixture {};

TEST_F(InteractiveFailureTest, ASceneThatCannotBeLoadedLeavesTheOldOne) {
    InteractiveSession session(setup(4));
    ASSERT_TRUE(reaches(session, isFinished));
    const auto scene = session.state().scene;
    std::ofstream(folder_ / "bad.json") << "{\"camera\": 12";
    session.open((folder_ / "bad.json").string());
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.errorSerial == 1; }));
    EXPECT_NE(session.state().errors.back().text.find("bad.json"), std::string::npos);
    EXPECT_EQ(session.state().scene, scene);
    EXPECT_FALSE(session.state().fatal);
    EXPECT_EQ(session.state().failedSource, (folder_ / "bad.json").string());
    EXPECT_EQ(session.state().sceneFailures, 1u);
    EXPECT_EQ(session.state().sceneLoads, 1u);
    session.open("no-such-scene");
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.errorSerial == 2; }));
    EXPECT_EQ(session.state().scene, scene);
    session.open("one-weekend-default");
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.sceneSerial == 2 && isFinished(s); }));
    EXPECT_EQ(session.state().scene->id, "one-weekend-default");
    EXPECT_EQ(session.state().source, "one-weekend-default");
    EXPECT_EQ(session.state().sceneLoads, 2u);
    session.open("one-weekend-default"); // the same one again
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.sceneLoads == 3; }));
    EXPECT_EQ(session.state().sceneSerial, 2u);
}

TEST_F(InteractiveFailureTest, ARememberedSceneThatIsGoneGivesWayToAnother) {
    InteractiveSession::Setup with = setup(4);
    with.scene.source = (folder_ / "gone.json").string();
    with.fallbackScene = "one-weekend-default";
    InteractiveSession session(std::move(with));
    ASSERT_TRUE(reaches(session, isFinished));
    EXPECT_EQ(session.state().source, "one-weekend-default");
    EXPECT_NE(session.state().errors.back().text.find("gone.json"), std::string::npos);
    EXPECT_EQ(session.state().fatal, nullptr);
}

TEST_F(InteractiveFailureTest, WhatCannotStartIsFatal) {
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

TEST_F(InteractiveFailureTest, AnEngineThatFailsIsReplacedWhenItIsNeededAgain) {
    InteractiveSession::Setup s = setup(4);
    int made = 0;
    s.makeEngine = [&made](const EngineChoice&) -> std::unique_ptr<Engine> {
        if (++made == 1) return std::make_unique<FailingEngine>();
        return std::make_unique<FakeEngine>();
    };
    InteractiveSession session(s);
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.activity == Activity::Failed; }));
    EXPECT_EQ(session.state().errors.back().text, "the device was lost");
    session.render();
    EXPECT_TRUE(reaches(session, isFinished));
    EXPECT_EQ(made, 2);
}

// What had been rendered can be saved, and is what the program leaves at its end; only what needs rays makes another
// engine.
TEST_F(InteractiveFailureTest, AFilmThatFailedKeepsItsSamples) {
    const std::string atEnd = (folder_ / "end.pfm").string(), saved = (folder_ / "saved.pfm").string();
    InteractiveSession::Setup s = setup(100);
    int made = 0;
    s.makeEngine = [&made](const EngineChoice&) {
        ++made;
        auto engine = std::make_unique<SlowEngine>();
        engine->onSample = [](std::uint32_t spp) {
            if (spp == 20) throw RenderError("the device was lost");
        };
        return engine;
    };
    s.atEnd = {.files = {atEnd}, .stats = (folder_ / "stats.json").string()};
    InteractiveSession session(s);
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.activity == Activity::Failed; }));
    session.save({.files = {saved}});
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.messageSerial == 1; }));
    EXPECT_EQ(session.state().activity, Activity::Failed);
    EXPECT_EQ(made, 1);
    EXPECT_TRUE(session.close().failures.empty());
    FakeEngine engine;
    RenderSettings settings = session.state().settings;
    settings.spp = 20;
    const std::atomic<bool> goOn{false};
    FilmRun(engine, session.state().scene->camera, settings).untilStopped(goOn);
    EXPECT_EQ(image::readImage(saved).data, engine.film().resolve().data);
    EXPECT_EQ(image::readImage(atEnd).data, engine.film().resolve().data);
    const std::string text = test::bytesOfFile(folder_ / "stats.json");
    EXPECT_NE(text.find("\"stopped_by\": \"failure\""), std::string::npos) << text;
}

TEST_F(InteractiveFailureTest, AnEngineThatCannotBeHadLeavesTheOneBeforeAtWork) {
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
    EXPECT_EQ(session.state().errors.back().text, "no pipeline");
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

} // namespace
} // namespace rt::app
