// The time of a scene that moves, as a window steers it: what is asked of the session, and when.
#include <memory>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "Common/App/Interactive/Timeline.h"

namespace rt::app {
namespace {

class TimelineTest : public testing::Test {
  protected:
    TimelineTest() {
        state_.sceneReads = 1;
        state_.activity = Activity::Rendering;
        show(0);
    }
    // Two animations, the first of 2 s, at that time.
    void show(double time) {
        auto scene = std::make_shared<scene::CompiledScene>();
        scene->motion = {{"walk", "wave"}, 0, 2, time};
        state_.scene = scene;
    }
    void follow() { timeline_.follow(state_, isEdited_, now_); }
    void followAt(double now) {
        now_ = now;
        follow();
    }
    // The session gets what is wished, if anything is.
    std::optional<double> send() {
        const auto wish = timeline_.next();
        if (!wish) return std::nullopt;
        asked_ = *wish;
        timeline_.sent(++number_);
        return wish->moment.time;
    }
    // Its scene is there; a picture of it is, too.
    void load() {
        show(asked_.moment.time);
        state_.moment = asked_.moment;
        state_.shutter = asked_.shutter;
        state_.scenePoses = number_;
        ++state_.sceneReads;
    }
    void answer() {
        load();
        follow();
        ++state_.picture.serial;
    }

    SessionState state_;
    Timeline timeline_;
    Timeline::Wish asked_;
    std::uint64_t number_ = 0;
    double now_ = 0;
    bool isEdited_ = false;
};

TEST_F(TimelineTest, AsksForWhatIsWishedOnce) {
    follow();
    EXPECT_FALSE(send());
    timeline_.goTo(0.5);
    EXPECT_EQ(timeline_.time(), 0.5);
    EXPECT_EQ(send(), 0.5);
    EXPECT_TRUE(asked_.moment.isWhole);
    EXPECT_EQ(asked_.moment.animation, "walk");
    answer();
    follow();
    EXPECT_FALSE(send());
    EXPECT_EQ(timeline_.time(), 0.5);
    timeline_.goTo(0.5);
    follow();
    EXPECT_FALSE(send()); // it is there
}

// What was wished meanwhile is left out, but for the last.
TEST_F(TimelineTest, WaitsForAPictureAndThenTakesTheNewestWish) {
    follow();
    timeline_.goTo(0.1);
    EXPECT_EQ(send(), 0.1);
    for (const double time : {0.2, 0.3, 0.4}) {
        timeline_.goTo(time);
        follow();
        EXPECT_FALSE(send());
        EXPECT_EQ(timeline_.time(), time);
    }
    load(); // its scene is there, and what is seen is still of the one before
    follow();
    EXPECT_FALSE(send());
    ++state_.picture.serial;
    follow();
    EXPECT_EQ(send(), 0.4);
}

TEST_F(TimelineTest, WaitsForNoPictureOfAFilmThatRests) {
    follow();
    timeline_.goTo(0.1);
    send();
    timeline_.goTo(0.2);
    load();
    state_.activity = Activity::Stopped;
    follow();
    EXPECT_EQ(send(), 0.2);
}

TEST_F(TimelineTest, PlaysByTheClockAndLeavesFramesOut) {
    follow();
    timeline_.setFrameRate(10);
    timeline_.play(true);
    followAt(100);
    EXPECT_FALSE(send()); // it is at that frame
    followAt(100.05);
    EXPECT_FALSE(send());
    followAt(100.11);
    EXPECT_DOUBLE_EQ(send().value(), 0.1);
    followAt(100.75); // no picture yet
    EXPECT_FALSE(send());
    answer();
    followAt(100.98);
    EXPECT_DOUBLE_EQ(send().value(), 0.9);
    answer();
    followAt(102.31); // round
    EXPECT_DOUBLE_EQ(send().value(), 0.3);
    EXPECT_TRUE(timeline_.isPlaying());
    answer();
    timeline_.setLoops(false);
    followAt(103.91);
    EXPECT_DOUBLE_EQ(send().value(), 1.9);
    answer();
    followAt(104.2);
    EXPECT_EQ(send(), 2);
    EXPECT_FALSE(timeline_.isPlaying());
    answer();
    follow();
    timeline_.play(true); // from the start
    followAt(105);
    EXPECT_EQ(send(), 0);
}

TEST_F(TimelineTest, PlaysOnFromWhereItIsMoved) {
    follow();
    timeline_.setFrameRate(10);
    timeline_.play(true);
    followAt(10);
    timeline_.goTo(1);
    followAt(11);
    EXPECT_EQ(send(), 1);
    answer();
    followAt(11.25);
    EXPECT_DOUBLE_EQ(send().value(), 1.2);
}

TEST_F(TimelineTest, StepsFromFrameToFrameWithinTheLength) {
    follow();
    timeline_.setFrameRate(24);
    timeline_.step(-1);
    EXPECT_EQ(timeline_.time(), 0);
    for (int i = 1; i <= 30; ++i) {
        timeline_.step(1);
        EXPECT_NEAR(timeline_.time(), i / 24.0, 1e-12);
    }
    timeline_.goTo(0.99 / 24);
    timeline_.step(1);
    EXPECT_NEAR(timeline_.time(), 1 / 24.0, 1e-12);
    timeline_.goTo(1.01 / 24);
    timeline_.step(-1);
    EXPECT_NEAR(timeline_.time(), 1 / 24.0, 1e-12);
    timeline_.goTo(2);
    timeline_.step(1);
    EXPECT_EQ(timeline_.time(), 2);
}

TEST_F(TimelineTest, ChoosesAnotherAnimationFromItsStart) {
    follow();
    timeline_.goTo(1);
    timeline_.choose("wave");
    EXPECT_EQ(send(), 0);
    EXPECT_EQ(asked_.moment.animation, "wave");
}

TEST_F(TimelineTest, OpensTheShutterAboutTheTimeThatIsShown) {
    follow();
    timeline_.goTo(0.5);
    timeline_.setShutter({0, 0.25});
    EXPECT_EQ(send(), 0.5);
    EXPECT_EQ(asked_.shutter, (scene::Shutter{0, 0.25}));
    answer();
    state_.poses = [](double) { return nullptr; };
    show(0.625); // the scene is that of the shutter's middle
    follow();
    EXPECT_EQ(timeline_.time(), 0.5);
    EXPECT_EQ(timeline_.shutter().close, 0.25);
    EXPECT_FALSE(send());
    state_.moment = {}; // as a scene file imports it
    follow();
    EXPECT_DOUBLE_EQ(timeline_.time(), 0.5);
}

// Of a pose that cannot be had, of the session's stop, and of another scene no wish is left.
TEST_F(TimelineTest, ForgetsWhatIsOfNoUseAnyMore) {
    const auto begin = [this] {
        follow();
        timeline_.goTo(0.5);
        EXPECT_EQ(send(), 0.5);
        timeline_.goTo(1);
        timeline_.play(true);
    };
    const auto expectStill = [this] {
        EXPECT_FALSE(timeline_.isPlaying());
        EXPECT_FALSE(timeline_.isWaiting());
        EXPECT_EQ(timeline_.time(), 0);
        EXPECT_FALSE(send());
    };
    begin();
    state_.failedPose = number_;
    follow();
    expectStill();
    begin();
    timeline_.giveUp();
    expectStill();
    begin();
    state_.scenePoses = 0;
    ++state_.sceneReads;
    follow();
    expectStill();
    begin();
    isEdited_ = true;
    follow();
    expectStill();
}

TEST_F(TimelineTest, SaysWhyItCannotMove) {
    EXPECT_STREQ(timeline_.whyNot(), "nothing moves in the scene");
    follow();
    EXPECT_EQ(timeline_.whyNot(), nullptr);
    isEdited_ = true;
    follow();
    ASSERT_NE(timeline_.whyNot(), nullptr);
    EXPECT_NE(std::string(timeline_.whyNot()).find("not saved"), std::string::npos);
    timeline_.goTo(1);
    timeline_.play(true);
    timeline_.choose("wave");
    timeline_.setShutter({0, 1});
    follow();
    EXPECT_FALSE(send());
    isEdited_ = false;
    state_.scene = std::make_shared<scene::CompiledScene>();
    follow();
    EXPECT_FALSE(timeline_.isMoving());
    timeline_.step(1);
    follow();
    EXPECT_FALSE(send());
}

} // namespace
} // namespace rt::app
