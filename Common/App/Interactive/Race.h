// A race: one picture rendered in several ways, each for the same time, and how far each is from the reference by then.
// What has been measured is told; there is no clock here.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "Common/App/Interactive/ErrorCurve.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Render/Settings.h"

namespace rt::app {

struct RaceEntrant {
    RenderSettings settings; // of which its methods count; all else is the race's
    bool isDenoised = false;
    bool isOther = false; // rendered by the other program, on its device and at the same time
    bool operator==(const RaceEntrant&) const = default;
};

inline constexpr std::size_t kMinEntrants = 2, kMaxEntrants = 4;
inline constexpr double kReferenceShare = 4; // of the time that each has, which a reference is rendered for
inline constexpr double kMinRaceSeconds = 0.1, kMaxRaceSeconds = 1e5;

struct RaceRequest {
    std::vector<RaceEntrant> entrants;
    double seconds = 10; // that each gets
};

// By what tells each from the others: "MIS (power heuristic), denoised". Those that are alike are numbered.
std::vector<std::string> namesOf(const std::vector<RaceEntrant>& entrants, bool isGpu,
                                 const std::string& noun = "Entrant");

// An entrant and how far it is.
struct RaceLane {
    RaceEntrant entrant;
    std::string name;
    std::string engine, device; // empty: not known yet
    bool isSoftware = false;    // a Vulkan device whose work the processor does
    double seconds = 0;         // that it has had
    std::vector<ErrorPoint> curve;
    std::string trouble; // why it ended early or has no error; empty: nothing is wrong
    bool isOut = false;  // gets no more time
};

class Race {
  public:
    Race() = default;
    Race(const RaceRequest& request, bool isGpu);

    // Of this program's entrants that are to have more time the one that has had least; the first of several. None:
    // there are none.
    std::optional<std::size_t> next() const;
    double secondsLeft(std::size_t entrant) const;
    void spend(std::size_t entrant, double seconds); // that it has had by now, in all
    // Whether its picture is to be looked at: at times that grow by a fifth, by half where that is filtered, and at its
    // end.
    bool isLookDue(std::size_t entrant) const;
    void look(std::size_t entrant, std::optional<ErrorPoint> point); // none: there is no whole picture yet
    void finish(std::size_t entrant);                                // it has had its time, and has been looked at then
    void drop(std::size_t entrant, const std::string& why);
    void end(); // nobody gets any more

    bool isOver() const;
    double secondsEach() const { return seconds_; }
    const std::vector<RaceLane>& lanes() const { return lanes_; }
    RaceLane& lane(std::size_t entrant) { return lanes_[entrant]; }

  private:
    std::vector<RaceLane> lanes_;
    std::vector<double> looks_; // the seconds at the last look at each
    double seconds_ = 0;
};

// Who is ahead when all have had as much time as the slowest in their midst.
struct RaceStanding {
    std::size_t leader = 0, second = 0;
    double seconds = 0; // that each had
    double factor = 1;  // by which the leader is ahead of the second, at least 1:
    bool isByTime =
        true; // the time to the second's error; false: error x time, where the curves have no error in common
};
// None while fewer than two have errors.
std::optional<RaceStanding> standingOf(const std::vector<RaceLane>& lanes);
// How far each is behind the leader, by the same measures; 1 for the leader. None: its error is not known.
std::optional<double> factorOf(const std::vector<RaceLane>& lanes, const RaceStanding& standing, std::size_t entrant);
// "MIS leads: the same error in 1/3.2 of the time of Off (BSDF only)".
std::string headlineOf(const std::vector<RaceLane>& lanes, const RaceStanding& standing);

// What is raced, beside the entrants.
struct RaceWork {
    SceneRequest request;
    std::string title; // of the scene
    scene::CameraDesc camera;
    RenderSettings settings;   // size, depth, Russian roulette, forced features
    std::uint32_t threads = 0; // of this program, as EngineChoice has it
};

// A race as a window sees it.
struct RaceState {
    enum class Phase { Preparing, Reference, Running, Over };
    Phase phase = Phase::Preparing;
    std::string stage; // of Preparing: what is being done
    RaceWork work;
    std::vector<RaceLane> lanes;
    double seconds = 0;                               // that each gets
    double referenceSeconds = 0, referenceWanted = 0; // of rendering the reference, in Reference
    double referenceError = 0;                        // its own relMSE; 0: not known
    std::string ending;                               // why it is over before its time; empty: it is not
    std::size_t shown = 0;                            // whose picture is
    bool isShown = false;                             // the picture is one of the race's
};

} // namespace rt::app
