// A race through the session of a window.
#include <algorithm>
#include <filesystem>
#include <string>

#include "tests/unit/InteractiveFixture.h"

namespace rt::app {
namespace {

using Phase = RaceState::Phase;

class InteractiveRaceTest : public InteractiveFixture {
  protected:
    static RaceRequest request(double seconds = 0.2) {
        RaceEntrant first, second;
        second.settings.lightSampling = LightSampling::Bsdf;
        return {{first, second}, seconds};
    }
    static bool isOver(const SessionState& state) { return state.race && state.race->phase == Phase::Over; }
    static bool isRunning(const SessionState& state) { return state.race && state.race->phase == Phase::Running; }
};

TEST_F(InteractiveRaceTest, EachGetsItsTimeAndAnErrorAgainstOneReference) {
    InteractiveSession session(setup(4));
    ASSERT_TRUE(reaches(session, isFinished));
    session.race(request());
    ASSERT_TRUE(reaches(session, isOver));
    const SessionState state = session.state();
    const RaceState& race = *state.race;
    ASSERT_EQ(race.lanes.size(), 2u);
    for (const RaceLane& lane : race.lanes) {
        EXPECT_EQ(lane.trouble, "");
        EXPECT_GE(lane.seconds, 0.2);
        EXPECT_GT(lane.curve.size(), 0u);
        EXPECT_EQ(lane.engine, "multi");
    }
    EXPECT_GT(race.referenceError, 0);
    EXPECT_TRUE(state.picture.isOfRace);
    EXPECT_TRUE(race.isShown);
    EXPECT_TRUE(state.referenceFits); // the film is of the same view
    // Whose picture is seen is chosen, also when it is over.
    const std::size_t other = 1 - race.shown;
    session.showInRace(other);
    ASSERT_TRUE(reaches(session, [other](const SessionState& s) { return s.race->shown == other; }));
    session.showInRace(std::nullopt);
    ASSERT_TRUE(reaches(session, [other](const SessionState& s) { return s.race->shown != other; }));
    // The film comes back as it was.
    session.leaveRace();
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return !s.picture.isOfRace && !s.race->isShown; }));
    EXPECT_EQ(session.state().picture.spp, 4u);
    EXPECT_EQ(session.state().activity, Activity::Finished);
    EXPECT_EQ(session.state().race->lanes[0].curve.size(), race.lanes[0].curve.size());
}

TEST_F(InteractiveRaceTest, TheFilmRestsAndGoesOnAfterwards) {
    InteractiveSession session(setup(1'000'000));
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.picture.spp > 0; }));
    session.race(request(1e4));
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.race && s.race->phase == Phase::Reference; }));
    EXPECT_EQ(session.state().activity, Activity::Paused);
    session.stopRace();
    ASSERT_TRUE(reaches(session, isOver));
    EXPECT_EQ(session.state().race->ending, "stopped");
    EXPECT_EQ(session.state().activity, Activity::Paused); // until the race is left
    const std::uint64_t before = session.state().status.samplesDone;
    session.leaveRace();
    EXPECT_TRUE(reaches(session, [before](const SessionState& s) {
        return s.activity == Activity::Rendering && s.status.samplesDone > before;
    }));
}

TEST_F(InteractiveRaceTest, AnotherViewEndsIt) {
    auto with = setup(4);
    with.references = ReferenceCache(folder_ / "references");
    InteractiveSession session(with);
    ASSERT_TRUE(reaches(session, isFinished));
    session.renderReference(64); // which is there then
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.referenceFits && isFinished(s); }));
    session.race(request(0.1));
    ASSERT_TRUE(reaches(session, isOver));
    session.race(request(1e4));
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.race->seconds == 1e4; }));
    scene::CameraDesc camera = session.state().scene->camera;
    camera.lookFrom.x += 0.1;
    session.moveCamera(camera, session.state().sceneSerial);
    ASSERT_TRUE(
        reaches(session, [](const SessionState& s) { return isOver(s) && isFinished(s) && !s.picture.isOfRace; }));
    EXPECT_NE(session.state().race->ending, "");
}

// Is good for a warm-up and one turn.
class DroppingEngine : public SlowEngine {
  public:
    RenderStatus renderSome(const Budget& budget) override {
        if (++calls_ > 2) throw RenderError("the device was lost");
        return SlowEngine::renderSome(budget);
    }

  private:
    int calls_ = 0;
};

TEST_F(InteractiveRaceTest, WhoFailsDropsOutAndTheOthersGoOn) {
    auto with = setup(4);
    int engines = 0;
    with.makeEngine = [&engines](const EngineChoice&) -> std::unique_ptr<Engine> {
        if (++engines == 3) return std::make_unique<DroppingEngine>(); // the second entrant's
        return std::make_unique<SlowEngine>();
    };
    InteractiveSession session(with);
    ASSERT_TRUE(reaches(session, isFinished));
    session.race(request(1));
    ASSERT_TRUE(reaches(session, isOver));
    const SessionState state = session.state();
    EXPECT_EQ(state.race->lanes[0].trouble, "");
    EXPECT_GE(state.race->lanes[0].seconds, 1);
    EXPECT_EQ(state.race->lanes[1].trouble, "the device was lost");
}

// The other program is not where it is looked for.
TEST_F(InteractiveRaceTest, AnOtherProgramThatCannotBeHadIsTold) {
    auto with = setup(4);
    with.programs = folder_ / "nowhere";
    InteractiveSession session(with);
    ASSERT_TRUE(reaches(session, isFinished));
    RaceRequest mixed = request();
    mixed.entrants[1].isOther = true;
    session.race(mixed);
    ASSERT_TRUE(reaches(session, isOver));
    const SessionState state = session.state();
    EXPECT_GT(state.race->lanes[0].curve.size(), 0u);
    EXPECT_NE(state.race->lanes[1].trouble.find("ray-tracing-gpu"), std::string::npos) << state.race->lanes[1].trouble;
}

TEST_F(InteractiveRaceTest, ItsPictureIsSaved) {
    InteractiveSession session(setup(4));
    ASSERT_TRUE(reaches(session, isFinished));
    session.race(request(0.1));
    ASSERT_TRUE(reaches(session, isOver));
    SaveRequest save;
    save.files = {(folder_ / "race.exr").string()};
    session.save(save);
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.messageSerial > 0; }));
    EXPECT_TRUE(std::filesystem::is_regular_file(folder_ / "race.exr"));
    EXPECT_EQ(session.state().errorSerial, 0u);
}

} // namespace
} // namespace rt::app
