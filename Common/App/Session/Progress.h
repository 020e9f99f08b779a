// How far a render is: one line that is rewritten on a terminal, else a line now and then.
#pragma once
#include <cstdint>
#include <optional>
#include <ostream>
#include <string>

namespace rt::app {

struct ProgressState {
    std::uint64_t samplesDone = 0; // over all pixels, restored ones included
    std::uint64_t samplesTotal = 0;
    std::uint64_t samplesRestored = 0; // from a checkpoint: they took no time
    std::uint64_t pixels = 1;
    double seconds = 0;              // since sampling began
    std::optional<double> timeLimit; // seconds
    std::size_t ranks = 0;           // processes that share the render; 0: it is one
    double minBusy = 0;              // of the ranks: share of the time that the one with the least to do has worked
};

// "37/100 spp  37%  4.21 M samples/s  1:05 left"
std::string describeProgress(const ProgressState& state);

class Progress {
  public:
    enum class Style { Silent, Terminal, Lines };

    static constexpr double kLineSeconds = 10;
    // `lineSeconds`: between two lines, in the style of lines.
    Progress(std::ostream& out, Style style, double lineSeconds = kLineSeconds)
        : out_(out), style_(style), lineSeconds_(lineSeconds) {}

    // Writes at most 5 times a second on a terminal, else a line now and then.
    void update(const ProgressState& state);
    // Says how it ended and closes the line.
    void finish(const ProgressState& state, const std::string& ending);

  private:
    void write(const std::string& text, bool last);

    std::ostream& out_;
    Style style_;
    double lineSeconds_;
    std::optional<double> lastSeconds_;
    std::size_t lastLength_ = 0;
};

} // namespace rt::app
