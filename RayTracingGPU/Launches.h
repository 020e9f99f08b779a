// How much work one launch gets: as much as takes a bounded time, found by measuring.
#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>

namespace rt::gpu {

// How long a launch may be. A window's draws wait for at most one, which leaves them half of a frame; no watchdog
// fires, and a cancelled render ends at once. A device that is the processor runs draws and launches side by side.
inline constexpr double kLaunchSeconds = 0.008;
inline constexpr double kSoftLaunchSeconds = 0.02;
inline double launchSeconds(bool softwareDevice) {
    return softwareDevice ? kSoftLaunchSeconds : kLaunchSeconds;
}

class LaunchSize {
  public:
    // Of launches of at most `seconds`, or as suits the device. Begins with so few samples that even a slow device of
    // its kind is done with them in time, and with fewer where paths may be long.
    LaunchSize(bool softwareDevice, std::uint32_t maxDepth, std::optional<double> seconds = {})
        : seconds_(seconds.value_or(launchSeconds(softwareDevice))),
          samples_((softwareDevice ? 4e5 : 8e6) * seconds_ / std::max(1.0, maxDepth / 64.0)) {}

    // Samples for a launch: a reserve is kept, since some take longer than others.
    std::uint64_t suggest() {
        constexpr double kReserve = 0.875;
        suggested_ = kReserve * samples_;
        return static_cast<std::uint64_t>(std::max(suggested_, 1.0));
    }

    // A launch of `samples` took `seconds`.
    void measured(std::uint64_t samples, double seconds) {
        constexpr double kLargestStep = 16;
        const double done = static_cast<double>(samples);
        // What remained of a pass may be too little to tell how fast the device is.
        if (done < 0.5 * suggested_ && seconds < seconds_) return;
        samples_ = done * std::min(seconds_ / std::max(seconds, 1e-6), kLargestStep);
    }

    // As many as the device does in that time, as far as is known.
    std::uint64_t samplesIn(double seconds) const { return static_cast<std::uint64_t>(samples_ / seconds_ * seconds); }
    // How long the device is going to take for them, as far as is known.
    double secondsFor(std::uint64_t samples) const { return static_cast<double>(samples) / samples_ * seconds_; }

  private:
    double seconds_;
    double samples_; // that take so long, as far as is known
    double suggested_ = 0;
};

} // namespace rt::gpu
