#include "Common/Render/Progress.h"

#include <algorithm>
#include <cmath>

#include "Common/Core/Format.h"

namespace rt::app {
namespace {

constexpr double kTerminalSeconds = 0.2;

std::string describeRate(double samplesPerSecond) {
    if (samplesPerSecond >= 1e9) return formatted("%.2f G samples/s", samplesPerSecond * 1e-9);
    if (samplesPerSecond >= 1e6) return formatted("%.2f M samples/s", samplesPerSecond * 1e-6);
    return formatted("%.1f k samples/s", samplesPerSecond * 1e-3);
}

// 0:07, 12:05, 3:00:00
std::string describeSeconds(double seconds) {
    const auto whole = static_cast<long long>(std::ceil(std::min(seconds, 1e15)));
    const int s = static_cast<int>(whole % 60);
    const int m = static_cast<int>(whole / 60 % 60);
    if (whole < 3600) return formatted("%d:%02d", m, s);
    return formatted("%lld:%02d:%02d", whole / 3600, m, s);
}

double samplesPerSecond(const ProgressState& state) {
    return state.seconds > 0 ? static_cast<double>(state.samplesDone - state.samplesRestored) / state.seconds : 0;
}

} // namespace

std::string describeProgress(const ProgressState& state) {
    const double share = state.samplesTotal > 0 ? static_cast<double>(state.samplesDone) / state.samplesTotal : 1;
    const double rate = samplesPerSecond(state);
    std::string text = std::to_string(state.samplesDone / state.pixels) + "/" +
                       std::to_string(state.samplesTotal / state.pixels) + " spp  " +
                       formatted("%.0f%%", std::floor(100 * share));
    if (rate > 0) {
        double left = static_cast<double>(state.samplesTotal - state.samplesDone) / rate;
        if (state.timeLimit) left = std::min(left, std::max(0.0, *state.timeLimit - state.seconds));
        text += "  " + describeRate(rate) + "  " + describeSeconds(left) + " left";
    }
    if (state.ranks > 0)
        text += "  " + std::to_string(state.ranks) + " ranks, least busy " + formatted("%.0f%%", 100 * state.minBusy);
    return text;
}

void Progress::update(const ProgressState& state) {
    if (style_ == Style::Silent) return;
    const bool terminal = style_ == Style::Terminal;
    // On a terminal the first line comes at once, elsewhere only a render that takes long says how far it is.
    const double last = lastSeconds_.value_or(terminal ? -kTerminalSeconds : 0.0);
    if (state.seconds - last < (terminal ? kTerminalSeconds : lineSeconds_)) return;
    lastSeconds_ = state.seconds;
    write(describeProgress(state), false);
}

void Progress::finish(const ProgressState& state, const std::string& ending) {
    if (style_ == Style::Silent) return;
    write(std::to_string(state.samplesDone / state.pixels) + " spp in " + formatted("%.2f s", state.seconds) + "  " +
              describeRate(samplesPerSecond(state)) + "  " + ending,
          true);
}

// Blanks cover what is left of a longer line before, so that no terminal needs to know escape sequences.
void Progress::write(const std::string& text, bool last) {
    if (style_ == Style::Terminal) {
        const std::size_t blanks = lastLength_ > text.size() ? lastLength_ - text.size() : 0;
        out_ << '\r' << text << std::string(blanks, ' ') << (last ? "\n" : "") << std::flush;
        lastLength_ = text.size();
    } else {
        out_ << text << '\n' << std::flush;
    }
}

} // namespace rt::app
