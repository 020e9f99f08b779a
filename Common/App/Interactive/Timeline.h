// The time of a scene that moves, as a window steers it: what is wished of the session next, so that the picture
// follows as fast as it can and never lags behind.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "Common/App/Interactive/InteractiveState.h"
#include "Common/Scene/Moment.h"

namespace rt::app {

class Timeline {
  public:
    // A moment, with the shutter about it.
    struct Wish {
        scene::Moment moment;
        scene::Shutter shutter;
        bool operator==(const Wish&) const = default;
    };
    static constexpr double kLeastRate = 0.1, kMostRate = 1000;

    // Each frame: what the session shows by now, at `now` in seconds of any clock. `isEdited`: the scene has edits that
    // are not saved, so that nothing can move it.
    void follow(const SessionState& state, bool isEdited, double now);
    // What is to be asked of the session, which answers with this number; none while a picture of the wish before is
    // still to come. What was wished meanwhile is left out.
    std::optional<Wish> next() const;
    void sent(std::uint64_t number);

    bool isMoving() const { return !motion_.animations.empty(); } // something moves in the scene
    const char* whyNot() const;                                   // time cannot be changed; null: it can
    bool isPlaying() const { return isPlaying_; }
    bool isWaiting() const { return pending_.has_value(); } // for the session
    bool isPassing() const { return isPlaying_ && !pending_; }
    const scene::Motion& motion() const { return motion_; }
    double time() const { return wish().moment.time; } // seconds, as wished
    double length() const;                             // in seconds; as much as the time that is beyond it
    const scene::Shutter& shutter() const { return wish().shutter; }
    double frameRate() const { return frameRate_; } // frames a second
    bool loops() const { return loops_; }

    // All of these do nothing where whyNot() has a reason.
    void play(bool on); // from where it is, at the end from the start
    void goTo(double seconds);
    void step(int frames); // stands still then, at a frame
    void choose(const std::string& animation);
    void setShutter(const scene::Shutter& shutter);
    void setFrameRate(double rate);
    void setLoops(bool on) { loops_ = on; }
    void giveUp(); // all wishes: the session has been stopped

  private:
    const Wish& wish() const { return wanted_ ? *wanted_ : pending_ ? asked_ : shown_; }
    void run(double now);

    scene::Motion motion_;                 // of the scene that is shown
    Wish shown_;                           // what it is
    std::optional<Wish> wanted_;           // not sent yet
    Wish asked_;                           // sent, while pending_
    std::optional<std::uint64_t> pending_; // until it is seen
    std::optional<std::uint64_t> before_;  // the picture's serial when its scene was there
    std::uint64_t reads_ = 0;              // of scenes, that this has followed
    bool isEdited_ = false, isPlaying_ = false, loops_ = true;
    double frameRate_ = 24;
    std::optional<double> startedAt_; // of `now`, when it was at startTime_
    double startTime_ = 0;
};

} // namespace rt::app
