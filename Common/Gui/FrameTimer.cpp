#include "Common/Gui/FrameTimer.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace rt::gui {
namespace {

constexpr double kLateSeconds = 10;

} // namespace

void FrameTimer::add(double seconds) {
    if (!std::exchange(started_, true)) return; // that turn has built the interface
    const double now = clock_.seconds();
    turns_.push_back({now, seconds});
    while (turns_.front().end < now - kLateSeconds) turns_.pop_front();
    std::vector<double> lengths;
    int lastSecond = 0;
    for (const Turn& turn : turns_) {
        lengths.push_back(turn.seconds);
        lastSecond += turn.end > now - 1;
    }
    figures_.window.framesPerSecond = lastSecond;
    figures_.longestOfLate = *std::max_element(lengths.begin(), lengths.end());
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    figures_.window.medianTurn = *middle;
    figures_.window.longestTurn = std::max(figures_.window.longestTurn, seconds);
}

} // namespace rt::gui
