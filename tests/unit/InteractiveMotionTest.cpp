// A window's session of a scene that moves: other moments, the camera that goes with it, an open shutter.
#include <algorithm>
#include <string>
#include <vector>

#include "RayTracingCPU/CpuEngine.h"
#include "tests/unit/InteractiveFixture.h"
#include "tests/unit/MovingModels.h"

namespace rt::app {
namespace {

class InteractiveMotionTest : public InteractiveFixture {
  protected:
    InteractiveSession::Setup setupOf(const std::string& scene, std::uint32_t spp = 4) const {
        InteractiveSession::Setup setup = InteractiveFixture::setup(spp);
        setup.makeEngine = [](const EngineChoice&) { return cpu::makeCpuEngine({}); };
        setup.scene = {scene, true};
        return setup;
    }
    std::string movingLamp() const { return scene::saveMovingLamp(folder_ / "lamp.glb").string(); }
    static scene::Moment at(double time) { return {"", time, true, true}; }
    static bool shows(const InteractiveSession& session, std::uint64_t pose) {
        return reaches(session, [pose](const SessionState& state) {
            return state.scenePoses >= pose && isFinished(state) && state.picture.spp >= 4;
        });
    }
};

TEST_F(InteractiveMotionTest, ShowsAnotherMomentAndKeepsTheView) {
    InteractiveSession session(setupOf(movingLamp()));
    ASSERT_TRUE(reaches(session, isFinished));
    const SessionState before = session.state();
    EXPECT_EQ(before.scenePoses, 0u);
    ASSERT_TRUE(shows(session, session.pose(at(0.5), {})));
    const SessionState after = session.state();
    EXPECT_EQ(after.moment, at(0.5));
    EXPECT_EQ(after.scene->motion.time, 0.5);
    EXPECT_NE(after.scene->hash, before.scene->hash);
    EXPECT_NE(after.picture.radiance->data, before.picture.radiance->data);
    EXPECT_EQ(after.sceneSerial, before.sceneSerial);
    EXPECT_GT(after.sceneReads, before.sceneReads); // a description of it is another one
    session.open(after.source);                     // as it is read again
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.scenePoses == 0 && isFinished(state); }));
    EXPECT_EQ(session.state().scene->hash, after.scene->hash);
}

TEST_F(InteractiveMotionTest, TheNewestWishIsShownInTheEnd) {
    InteractiveSession session(setupOf(movingLamp()));
    ASSERT_TRUE(reaches(session, isFinished));
    std::uint64_t last = 0;
    for (int i = 1; i <= 20; ++i) last = session.pose(at(i / 20.0), {});
    ASSERT_TRUE(shows(session, last));
    EXPECT_EQ(session.state().moment, at(1));
}

TEST_F(InteractiveMotionTest, OneThatCannotBeHadLeavesTheOneBefore) {
    InteractiveSession session(setupOf(movingLamp()));
    ASSERT_TRUE(reaches(session, isFinished));
    const std::uint64_t failed = session.pose({"no such", 0.5, true, true}, {});
    ASSERT_TRUE(reaches(session, [failed](const SessionState& state) { return state.failedPose == failed; }));
    const SessionState state = session.state();
    EXPECT_EQ(state.sceneFailures, 0u); // the file is well
    ASSERT_FALSE(state.errors.empty());
    EXPECT_NE(state.errors.back().text.find("--animation no such"), std::string::npos);
    ASSERT_TRUE(shows(session, session.pose(at(0.5), {})));
}

TEST_F(InteractiveMotionTest, TheScenesCameraMovesWithItAndTheUsersStays) {
    scene::MovingModel model;
    model.addNode({{"mesh", model.addMesh(model.lamp(0.5f, 4))}});
    model.move(model.addCamera(), "translation", {0, 0, 10}, {2, 0, 10});
    InteractiveSession session(setupOf(model.save(folder_ / "camera.glb").string()));
    ASSERT_TRUE(reaches(session, isFinished));
    const SessionState before = session.state();
    ASSERT_TRUE(shows(session, session.pose(at(0.5), {})));
    const SessionState moved = session.state();
    EXPECT_GT(moved.sceneSerial, before.sceneSerial);
    EXPECT_EQ(moved.sceneCamera, moved.scene->camera);
    EXPECT_NEAR(moved.sceneCamera.lookFrom.x, 1, 1e-6);
    scene::CameraDesc own = moved.sceneCamera;
    own.lookFrom.y += 1;
    session.moveCamera(own, moved.sceneSerial);
    ASSERT_TRUE(shows(session, session.pose(at(1), {})));
    EXPECT_EQ(session.state().sceneSerial, moved.sceneSerial);
}

// It is the picture that the command line makes, whose film is of one kind of samples as well.
TEST_F(InteractiveMotionTest, AnOpenShutterBlurs) {
    InteractiveSession::Setup setup = setupOf(movingLamp(), 16);
    setup.request.settings.adaptive = true; // which poses are not for
    InteractiveSession session(setup);
    ASSERT_TRUE(reaches(session, isFinished));
    ASSERT_TRUE(shows(session, session.pose(at(0), {0, 1})));
    const SessionState blurred = session.state();
    ASSERT_TRUE(blurred.report.shutter);
    EXPECT_EQ(blurred.report.shutter->open, 0);
    EXPECT_EQ(blurred.report.shutter->close, 1);
    EXPECT_GE(blurred.report.shutter->poses, 16u);
    EXPECT_FALSE(blurred.settings.adaptive);
    EXPECT_EQ(blurred.scene->motion.time, 0.5);
    ASSERT_TRUE(shows(session, session.pose(at(0), {})));
    const SessionState sharp = session.state();
    EXPECT_FALSE(sharp.report.shutter);
    const auto dark = [](const SessionState& state) { // pixels
        const std::vector<float>& values = state.picture.radiance->data;
        return std::count(values.begin(), values.end(), 0.0f);
    };
    EXPECT_LT(dark(blurred), dark(sharp)); // it passes more of them
}

TEST_F(InteractiveMotionTest, TheShutterIsOpenFromTheStart) {
    InteractiveSession::Setup setup = setupOf(movingLamp());
    setup.scene.moment = at(0.25);
    setup.scene.shutter = {-0.125, 0.125};
    InteractiveSession session(setup);
    ASSERT_TRUE(reaches(session, isFinished));
    ASSERT_TRUE(session.state().report.shutter);
    EXPECT_EQ(session.state().report.shutter->open, 0.125);
    InteractiveSession::Setup still = setupOf("cornell-box-lights");
    still.scene.shutter = {0, 1};
    InteractiveSession other(still);
    ASSERT_TRUE(reaches(other, isFinished));
    EXPECT_FALSE(other.state().report.shutter);
}

} // namespace
} // namespace rt::app
