// How long the turns of the window's thread take.
#pragma once
#include <deque>

#include "Common/App/Stopwatch.h"

namespace rt::gui {

struct UiFigures {
    double framesPerSecond = 0; // of the last second
    double longestStall = 0;    // seconds that one turn of the window's thread took, of the last ten seconds
};

class TurnMeter {
  public:
    void add(double seconds); // a turn of this length has just ended
    const UiFigures& figures() const { return figures_; }

  private:
    struct Turn {
        double end, seconds;
    };
    std::deque<Turn> turns_;
    app::Stopwatch clock_;
    UiFigures figures_;
};

} // namespace rt::gui
