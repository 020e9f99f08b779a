// Several viewports of a session, without any window.
#include <atomic>
#include <filesystem>
#include <optional>

#include "tests/unit/InteractiveFixture.h"

namespace rt::app {
namespace {

class InteractiveViewportsTest : public InteractiveFixture {
  protected:
    static constexpr std::uint32_t kEndless = 1'000'000;

    // With the picture of the first one.
    InteractiveSession& begin(InteractiveSession::Setup setup) {
        session_.emplace(std::move(setup));
        first_ = session_->addressed();
        EXPECT_TRUE(reaches([](const SessionState& s) { return s.picture.spp > 0; }));
        return *session_;
    }
    ViewportId open(std::uint32_t spp, double x = 0) {
        RenderRequest request = setup(spp).request;
        request.settings.lightSampling = LightSampling::Bsdf;
        scene::CameraDesc camera = session_->state().scene->camera;
        camera.lookFrom.x += x;
        return session_->openViewport(request, {}, camera, false);
    }
    template <class Condition>
    bool reaches(Condition condition) const {
        return InteractiveFixture::reaches(*session_, condition);
    }
    SessionState stateOf(ViewportId id) {
        const ViewportId before = session_->addressed();
        session_->address(id);
        SessionState state = session_->state();
        session_->address(before);
        return state;
    }

    std::optional<InteractiveSession> session_;
    ViewportId first_ = 0;
};

TEST_F(InteractiveViewportsTest, AllConvergeWithSettingsOfTheirOwn) {
    InteractiveSession& session = begin(setup(40));
    const ViewportId second = open(60);
    session.address(second);
    ASSERT_TRUE(reaches(isFinished));
    const SessionState state = session.state();
    EXPECT_EQ(state.picture.spp, 60u);
    EXPECT_EQ(state.settings.lightSampling, LightSampling::Bsdf);
    session.address(first_);
    ASSERT_TRUE(reaches(isFinished));
    EXPECT_EQ(session.state().picture.spp, 40u);
    EXPECT_EQ(session.state().settings.lightSampling, LightSampling::Mis);
    EXPECT_EQ(session.state().scene, state.scene); // one of both
    EXPECT_NE(session.state().picture.serial, state.picture.serial);
}

TEST_F(InteractiveViewportsTest, RequestsAreOfTheAddressedOne) {
    InteractiveSession& session = begin(setup(kEndless));
    const ViewportId second = open(kEndless);
    session.address(second);
    ASSERT_TRUE(reaches([](const SessionState& s) { return s.picture.spp > 0; }));
    session.pause();
    ASSERT_TRUE(reaches([](const SessionState& s) { return s.activity == Activity::Paused; }));
    EXPECT_EQ(stateOf(first_).activity, Activity::Rendering);
    session.address(first_);
    const std::uint64_t spp = session.state().picture.spp;
    ASSERT_TRUE(reaches([spp](const SessionState& s) { return s.picture.spp > spp + 2; })); // goes on
    EXPECT_EQ(stateOf(second).activity, Activity::Paused);
}

// The camera of the one with the focus is changed all the time: nobody else gets a sample, and gets them afterwards.
TEST_F(InteractiveViewportsTest, OnlyTheFocusIsRenderedWhileTheUserMovesIt) {
    InteractiveSession& session = begin(setup(kEndless));
    const ViewportId second = open(kEndless);
    session.address(second);
    ASSERT_TRUE(reaches([](const SessionState& s) { return s.picture.spp > 0; }));
    session.address(first_);
    session.hold(true);
    scene::CameraDesc camera = session.state().scene->camera;
    const auto move = [&] {
        camera.lookFrom.x += 0.01;
        session.moveCamera(camera, session.state().sceneSerial);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    };
    move();
    std::uint64_t serial = session.state().picture.serial;
    // What the other one was at is over when the focus has shown the new camera.
    ASSERT_TRUE(reaches([&](const SessionState& s) { return move(), s.picture.serial > serial + 1; }));
    const std::uint64_t others = stateOf(second).status.samplesDone, otherPicture = stateOf(second).picture.serial;
    serial = session.state().picture.serial;
    const auto isSeenFromElsewhere = [&](const SessionState& s) {
        return move(), s.picture.serial > serial + 20 && s.picture.camera != stateOf(second).picture.camera;
    };
    ASSERT_TRUE(reaches(isSeenFromElsewhere));
    EXPECT_EQ(stateOf(second).picture.camera, session.state().scene->camera) << "outlines lie where it shows objects";
    EXPECT_EQ(stateOf(second).status.samplesDone, others);
    EXPECT_EQ(stateOf(second).picture.serial, otherPicture);
    session.hold(false);
    session.address(second);
    EXPECT_TRUE(reaches([&](const SessionState& s) { return s.status.samplesDone > others; }));
}

TEST_F(InteractiveViewportsTest, EditsAndScenesReachAll) {
    InteractiveSession& session = begin(setup(kEndless));
    const ViewportId second = open(kEndless, 3);
    session.startEditing(loadScene("cornell-box-lights"));
    const std::uint64_t edit = session.edit({}, false);
    for (const ViewportId id : {first_, second}) {
        session.address(id);
        ASSERT_TRUE(reaches([&](const SessionState& s) { return s.sceneEdits == edit && s.picture.spp > 0; })) << id;
    }
    EXPECT_EQ(stateOf(first_).scene, stateOf(second).scene);
    session.address(first_);
    session.stopEditing();
    session.open("one-weekend-test");
    for (const ViewportId id : {first_, second}) {
        session.address(id);
        ASSERT_TRUE(reaches([](const SessionState& s) { return s.source == "one-weekend-test" && s.picture.spp > 0; }));
        EXPECT_EQ(session.state().sceneReads, 2u);
    }
    // One that is opened now has the edits, too.
    session.startEditing(loadScene("one-weekend-test"));
    const std::uint64_t next = session.edit({}, false);
    session.address(first_);
    ASSERT_TRUE(reaches([&](const SessionState& s) { return s.sceneEdits == next; }));
    const ViewportId third = open(kEndless);
    session.address(third);
    EXPECT_TRUE(reaches([&](const SessionState& s) { return s.sceneEdits == next && s.picture.spp > 0; }));
}

TEST_F(InteractiveViewportsTest, AClosedOneFreesItsEngine) {
    static std::atomic<int> engines{0};
    struct CountedEngine : SlowEngine {
        CountedEngine() { ++engines; }
        ~CountedEngine() override { --engines; }
    };
    InteractiveSession::Setup start = setup(kEndless);
    start.makeEngine = [](const EngineChoice&) { return std::make_unique<CountedEngine>(); };
    InteractiveSession& session = begin(std::move(start));
    const ViewportId second = open(kEndless);
    session.address(second);
    ASSERT_TRUE(reaches([](const SessionState& s) { return s.picture.spp > 0; }));
    EXPECT_EQ(engines, 2);
    session.setFocus(second);
    session.closeViewport(first_);
    EXPECT_TRUE(reaches([](const SessionState&) { return engines == 1; }));
    const std::uint64_t spp = session.state().picture.spp;
    EXPECT_TRUE(reaches([spp](const SessionState& s) { return s.picture.spp > spp; })); // goes on
    session.close();
    EXPECT_EQ(engines, 0);
}

// What the program was started to write is of the first one, and is written when that goes.
TEST_F(InteractiveViewportsTest, FilesOfTheEndAreOfTheFirst) {
    InteractiveSession::Setup start = setup(kEndless);
    start.atEnd = SaveRequest{.files = {(folder_ / "a.pfm").string()}};
    InteractiveSession& session = begin(std::move(start));
    const ViewportId second = open(2);
    session.address(second);
    ASSERT_TRUE(reaches(isFinished));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.pfm"));
    session.setFocus(second);
    session.closeViewport(first_);
    EXPECT_TRUE(reaches([this](const SessionState&) { return std::filesystem::exists(folder_ / "a.pfm"); }));
    const EndFiles files = session.close();
    EXPECT_TRUE(files.hasFilm);
    EXPECT_TRUE(files.failures.empty());
}

// An engine that cannot be had is the trouble of that viewport alone.
TEST_F(InteractiveViewportsTest, OneThatFailsLeavesTheOthers) {
    static std::atomic<int> made{0};
    made = 0;
    InteractiveSession::Setup start = setup(kEndless);
    start.makeEngine = [](const EngineChoice&) -> std::unique_ptr<Engine> {
        if (made++ > 0) throw RenderError("no second device");
        return std::make_unique<SlowEngine>();
    };
    InteractiveSession& session = begin(std::move(start));
    const ViewportId second = open(kEndless);
    session.address(second);
    ASSERT_TRUE(reaches([](const SessionState& s) { return static_cast<bool>(s.fatal); }));
    EXPECT_EQ(session.state().errors.back().text, "no second device");
    session.address(first_);
    EXPECT_FALSE(session.state().fatal);
    session.closeViewport(second);
    const std::uint64_t spp = session.state().picture.spp;
    EXPECT_TRUE(reaches([spp](const SessionState& s) { return s.picture.spp > spp; }));
}

TEST_F(InteractiveViewportsTest, OthersRestWhileOneRaces) {
    InteractiveSession& session = begin(setup(kEndless));
    const ViewportId second = open(kEndless);
    RaceEntrant a, b;
    b.settings.lightSampling = LightSampling::Bsdf;
    session.race({{a, b}, 0.2});
    ASSERT_TRUE(reaches([](const SessionState& s) { return s.race && s.race->phase == RaceState::Phase::Running; }));
    const std::uint64_t others = stateOf(second).status.samplesDone;
    ASSERT_TRUE(reaches([&](const SessionState&) {
        const std::uint64_t now = stateOf(second).status.samplesDone; // first: the race may end meanwhile
        const bool isOver = session.state().race->phase == RaceState::Phase::Over;
        EXPECT_TRUE(isOver || now == others);
        return isOver;
    }));
    session.address(second);
    EXPECT_TRUE(reaches([&](const SessionState& s) { return s.status.samplesDone > others; }));
}

} // namespace
} // namespace rt::app
