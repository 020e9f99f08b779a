#include "Common/Gui/TurnMeter.h"

#include <algorithm>

namespace rt::gui {
namespace {

constexpr double kStallSeconds = 10; // that the longest turn is looked for in

} // namespace

void TurnMeter::add(double seconds) {
    const double now = clock_.seconds();
    turns_.push_back({now, seconds});
    while (!turns_.empty() && turns_.front().end < now - kStallSeconds) turns_.pop_front();
    figures_ = {};
    for (const Turn& turn : turns_) {
        figures_.longestStall = std::max(figures_.longestStall, turn.seconds);
        figures_.framesPerSecond += turn.end > now - 1 ? 1 : 0;
    }
}

} // namespace rt::gui
