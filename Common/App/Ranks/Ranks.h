// A program as one of several ranks: how it joins the others, and how all end.
#pragma once
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "Common/App/Ranks/Communicator.h"

namespace rt::app {

inline constexpr std::chrono::milliseconds kPollInterval{1}; // of a rank that waits for messages: nearly idle

// How long a thread that waits for messages of other ranks rests between two looks: the longer none came, the longer.
class IdleWait {
  public:
    using Time = std::chrono::microseconds;

    // Beside threads that render, whether on this rank or on others: every look takes MPI some microseconds of a
    // processor that has better things to do. Where devices render instead, a lease may take no longer than such a
    // rest.
    explicit IdleWait(bool processorsRender) : processorsRender_(processorsRender) {}

    Time next() { return std::exchange(interval_, std::min(2 * interval_, longest())); }
    // A message has come.
    void wake() { interval_ = first_; }
    // A rank has worked so long at a lease: messages come about as often.
    void leaseTook(double seconds) {
        if (seconds <= 0) return;
        const auto part = std::chrono::duration_cast<Time>(std::chrono::duration<double>(seconds * kPart));
        first_ = std::clamp(part, kShortest, longest());
    }

  private:
    static constexpr Time kShortest{100}, kLongest{20000}, kLongestOfDevice{200};
    static constexpr double kPart = 0.25; // of a lease, of which a rank holds two

    Time longest() const { return processorsRender_ ? kLongest : kLongestOfDevice; }

    bool processorsRender_;
    Time first_ = kShortest; // after a message
    Time interval_ = kShortest;
};

// The ranks of the mpirun that has started this program; null when it was started alone. Throws UsageError where that
// needs MPI and this program was built without.
std::unique_ptr<Communicator> joinRanks();

// The frame of a program's main on one of `ranks`. Rank 0, or a program without ranks, runs `leader`, whose result is
// the exit code. The others run `follower`, which returns whether it has got rank 0's End; what it throws goes to rank
// 0, which throws it as its own. Returns when all have ended.
int runOnRank(Communicator* ranks, const std::function<int()>& leader, const std::function<bool()>& follower);

// So many threads that the ranks of this host share its processors.
std::uint32_t threadsOfRank(const Communicator& ranks);

} // namespace rt::app
