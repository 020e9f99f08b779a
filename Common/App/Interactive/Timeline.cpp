#include "Common/App/Interactive/Timeline.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rt::app {
namespace {

constexpr double kSlack = 1e-6; // of a frame: its own time, rounded, belongs to it

Timeline::Wish shownBy(const SessionState& state) {
    Timeline::Wish shown{state.moment, state.shutter};
    if (!state.scene) return shown;
    const scene::Motion& motion = state.scene->motion;
    // A scene file may say it, too.
    if (!state.moment.isWhole) shown.moment.time = motion.time - (state.poses ? state.shutter.middle() : 0);
    if (!motion.animations.empty()) shown.moment.animation = motion.animations[motion.chosen];
    shown.moment.isAsked = shown.moment.isWhole = true;
    return shown;
}

} // namespace

// ---- of the session ------------------------------------------------------------------------------------------------

void Timeline::follow(const SessionState& state, bool isEdited, double now) {
    isEdited_ = isEdited;
    motion_ = state.scene ? state.scene->motion : scene::Motion();
    shown_ = shownBy(state);
    const bool isOpened = std::exchange(reads_, state.sceneReads) != state.sceneReads && state.scenePoses == 0;
    const bool hasFailed = pending_ && state.failedPose >= *pending_;
    if (isOpened || hasFailed || whyNot() != nullptr) giveUp();
    if (pending_ && state.scenePoses >= *pending_) {
        if (!before_) before_ = state.picture.serial;
        // A film that does not go on shows nothing more.
        if (state.picture.serial != *before_ || state.activity != Activity::Rendering) pending_.reset();
    }
    if (isPlaying_) run(now);
    if (wanted_ && !pending_ && *wanted_ == shown_) wanted_.reset();
}

void Timeline::giveUp() {
    pending_.reset();
    wanted_.reset();
    isPlaying_ = false;
}

std::optional<Timeline::Wish> Timeline::next() const {
    return pending_ ? std::nullopt : wanted_;
}

void Timeline::sent(std::uint64_t number) {
    asked_ = *std::exchange(wanted_, std::nullopt);
    pending_ = number;
    before_.reset();
}

// ---- of the user ---------------------------------------------------------------------------------------------------

const char* Timeline::whyNot() const {
    if (!isMoving()) return "nothing moves in the scene";
    return isEdited_ ? "there are edits that are not saved: save them, and the model moves below them" : nullptr;
}

double Timeline::length() const {
    return std::max(motion_.length, time());
}

void Timeline::play(bool on) {
    if (whyNot() != nullptr || !(motion_.length > 0)) return;
    if (on && time() >= motion_.length) goTo(0);
    isPlaying_ = on;
    startedAt_.reset();
}

void Timeline::goTo(double seconds) {
    if (whyNot() != nullptr) return;
    wanted_ = Wish(wish());
    wanted_->moment.time = std::max(seconds, 0.0);
    startedAt_.reset();
}

void Timeline::step(int frames) {
    const double frame = time() * frameRate_;
    const double from = frames > 0 ? std::floor(frame + kSlack) : std::ceil(frame - kSlack);
    isPlaying_ = false;
    goTo(std::clamp((from + frames) / frameRate_, 0.0, length()));
}

void Timeline::choose(const std::string& animation) {
    if (whyNot() != nullptr) return;
    wanted_ = Wish(wish());
    wanted_->moment.animation = animation;
    goTo(0);
}

void Timeline::setShutter(const scene::Shutter& shutter) {
    if (whyNot() != nullptr) return;
    wanted_ = Wish(wish());
    wanted_->shutter = shutter;
}

void Timeline::setFrameRate(double rate) {
    frameRate_ = std::clamp(rate, kLeastRate, kMostRate);
}

// Where the clock says, whatever of it has been shown: frames that nobody had time for are left out.
void Timeline::run(double now) {
    if (!startedAt_) {
        startedAt_ = now;
        startTime_ = time();
    }
    const double seconds = startTime_ + (now - *startedAt_);
    if (seconds >= motion_.length && !loops_) {
        goTo(motion_.length);
        isPlaying_ = false;
        return;
    }
    startTime_ = std::fmod(seconds, motion_.length);
    startedAt_ = now;
    const double frame = std::floor(startTime_ * frameRate_ + kSlack) / frameRate_;
    if (frame == time()) return;
    goTo(frame);
    startedAt_ = now; // goes on
}

} // namespace rt::app
