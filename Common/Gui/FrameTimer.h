// How long the turns of the window's thread take.
#pragma once
#include <deque>

#include "Common/App/Session/Statistics.h"
#include "Common/App/Session/Stopwatch.h"

namespace rt::gui {

struct UiFigures {
    app::WindowFigures window;
    double longestOfLate = 0; // as window.longestTurn, of the last ten seconds
};

class FrameTimer {
  public:
    void add(double seconds); // a turn of this length has just ended
    const UiFigures& figures() const { return figures_; }

  private:
    struct Turn {
        double end, seconds;
    };
    std::deque<Turn> turns_;
    app::Stopwatch clock_;
    bool started_ = false;
    UiFigures figures_;
};

} // namespace rt::gui
