// What a window shows of a film besides its picture.
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/InteractiveFixture.h"

namespace rt::app {
namespace {

class InteractiveViewTest : public InteractiveFixture {};

// First hits take it so long that a view of them cannot have all samples at once.
class CostlyEngine : public FakeEngine {
  public:
    inline static std::atomic<std::uint32_t> rowsAgain{0}; // rendered a few at a time

    RenderStatus renderSome(const Budget& budget) override {
        std::this_thread::sleep_for(std::chrono::milliseconds(300)); // by which its speed is judged
        return FakeEngine::renderSome(budget);
    }
    AovImages renderAovs(const AovRequest& request, std::uint32_t samples) override {
        rowsAgain += request.rows;
        return FakeEngine::renderAovs(request, samples);
    }
};

TEST_F(InteractiveViewTest, ShowsFeaturesAndWhatAPixelHolds) {
    InteractiveSession session(setup(20));
    ASSERT_TRUE(reaches(session, isFinished));
    EXPECT_FALSE(session.state().picture.isDisplay);
    session.view({ViewMode::Albedo, 1, true});
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.picture.isDisplay; }));
    SessionState state = session.state();
    EXPECT_EQ(state.picture.image->data, std::vector<float>(24 * 24 * 3, 0.25f)); // of the fake engine
    EXPECT_NE(state.picture.radiance->data, state.picture.image->data);
    EXPECT_FALSE(state.picture.legend);
    ASSERT_TRUE(state.picture.samples && state.picture.variance);
    EXPECT_EQ(state.picture.samples->data, std::vector<float>(24 * 24, 20.0f));
    session.view({ViewMode::Noise, 1, false});
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return !s.picture.samples; }));
    EXPECT_TRUE(session.state().picture.isDisplay);
    const float maximum = session.state().picture.legend->maximum; // fits the noise that there is
    EXPECT_GT(maximum, 0);
    EXPECT_LT(maximum, 1);
    session.view({ViewMode::Noise, 4, false});
    ASSERT_TRUE(reaches(
        session, [&](const SessionState& s) { return s.picture.legend && s.picture.legend->maximum < maximum; }));
    EXPECT_EQ(session.state().picture.legend->quantity, Legend::Quantity::StandardError);
    EXPECT_EQ(session.state().picture.legend->maximum, 0.25f * maximum);
    session.view({ViewMode::Error, 1, false}); // without a reference it is the picture
    EXPECT_TRUE(reaches(session, [](const SessionState& s) { return !s.picture.isDisplay; }));
    EXPECT_FALSE(session.state().picture.legend);
    EXPECT_EQ(session.state().activity, Activity::Finished); // a view renders nothing anew
}

// As many as a film has, up to those of files.
TEST_F(InteractiveViewTest, FeaturesGetAsManySamplesAsInTheirFiles) {
    constexpr std::uint32_t kWidth = 300, kSpp = 4;
    CostlyEngine::rowsAgain = 0;
    InteractiveSession::Setup costly = setup(kSpp);
    costly.makeEngine = [](const EngineChoice&) { return std::make_unique<CostlyEngine>(); };
    costly.request.size.width = kWidth;
    InteractiveSession session(costly);
    ASSERT_TRUE(reaches(session, isFinished));
    session.view({ViewMode::Albedo, 1, false});
    const std::vector<float> wanted(kWidth * kWidth * 3, kSpp / 64.0f);
    EXPECT_TRUE(reaches(session, [&](const SessionState& s) { return s.picture.image->data == wanted; }));
    EXPECT_EQ(CostlyEngine::rowsAgain, kWidth);
    EXPECT_EQ(session.state().activity, Activity::Finished); // a view renders nothing anew
}

TEST_F(InteractiveViewTest, FocusIsThePlaneThroughWhatIsSeen) {
    InteractiveSession session(setup(4));
    ASSERT_TRUE(reaches(session, isFinished));
    session.pickFocus(0, 12);
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.focusSerial == 1; }));
    const double half = std::tan(0.5 * session.state().scene->camera.verticalFov * 3.14159265358979323846 / 180);
    const double right = half * (1.0 / 24 - 1), up = half * (25.0 / 24 - 1);
    EXPECT_NEAR(session.state().focusDistance, 8 / std::sqrt(1 + right * right + up * up), 1e-6);
    session.pickFocus(1000, 1000); // outside: nothing, which is said
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.messageSerial == 1; }));
    session.save({.files = {(folder_ / "a.png").string()}});
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.messageSerial == 2; }));
    EXPECT_EQ(session.state().focusSerial, 1u);
}

} // namespace
} // namespace rt::app
