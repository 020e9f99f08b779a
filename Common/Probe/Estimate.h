// How well a strategy estimates the light that lamps with an extent and the sky send to the camera by way of a surface,
// as luminance.
#pragma once
#include <cstdint>

#include "Common/Probe/Probe.h"

namespace rt::probe {

// From samples that come in any number of portions. Their numbers are independent of each other.
class DirectEstimate {
  public:
    // The probe must outlive it. The strategy has a density there.
    DirectEstimate(const Probe& probe, const Strategy& strategy, std::uint32_t seed);

    void advance(std::uint32_t samples); // of Mis an even number: a pair, one of each, is one value
    std::uint32_t samples() const { return samples_; }
    double mean() const { return mean_; }
    double variance() const; // of a sample: that of the mean, times the number of samples

  private:
    double valueOf(std::uint32_t sample) const;

    const Probe* probe_;
    Strategy strategy_;
    NumberSettings numbers_;
    std::uint32_t samples_ = 0;
    double mean_ = 0, squares_ = 0; // Welford 1962
};

} // namespace rt::probe
