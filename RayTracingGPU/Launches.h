// How much work one launch gets: as much as takes a bounded time, found by measuring.
#pragma once
#include <algorithm>
#include <cstdint>

namespace rt::gpu {

// No watchdog fires and a cancelled render ends soon when launches are short; a device is busy when they are not too short.
inline constexpr double kLaunchSeconds = 0.02;
// A window's draws wait for at most one launch, which leaves them half of a frame. Those of software are threads among threads.
inline constexpr double kWindowLaunchSeconds = 0.008;
inline double windowLaunchSeconds(bool isSoftware) {
    return isSoftware ? kLaunchSeconds : kWindowLaunchSeconds;
}

class LaunchSize {
  public:
    // Begins with so few samples that even a slow device of its kind is done with them in time, and with fewer where paths may
    // be long.
    LaunchSize(bool softwareDevice, std::uint32_t maxDepth)
        : samples_((softwareDevice ? 1 << 13 : 1 << 17) / std::max(1.0, maxDepth / 64.0)) {}

    // Samples for a launch of `seconds`, but at most kLaunchSeconds. Short ones must not take longer: they are planned shorter.
    std::uint64_t suggest(double seconds) {
        constexpr double kReserve = 0.875;
        suggested_ = samples_ * (seconds < kLaunchSeconds ? kReserve * seconds / kLaunchSeconds : 1);
        return static_cast<std::uint64_t>(std::max(suggested_, 1.0));
    }

    // A launch of `samples` took `seconds`.
    void measured(std::uint64_t samples, double seconds) {
        constexpr double kLargestStep = 16;
        const double done = static_cast<double>(samples);
        // What remained of a pass may be too little to tell how fast the device is.
        if (done < 0.5 * suggested_ && seconds < kLaunchSeconds) return;
        samples_ = done * std::min(kLaunchSeconds / std::max(seconds, 1e-6), kLargestStep);
    }

    // How long the device is going to take for them, as far as is known.
    double secondsFor(std::uint64_t samples) const { return static_cast<double>(samples) / samples_ * kLaunchSeconds; }

  private:
    double samples_; // that take kLaunchSeconds, as far as is known
    double suggested_ = 0;
};

} // namespace rt::gpu
