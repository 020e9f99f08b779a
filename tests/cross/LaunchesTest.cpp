// Launches are as long as they may be and no longer, once it is known how fast a device is.
#include <gtest/gtest.h>

#include "RayTracingGPU/Launches.h"

namespace rt::gpu {
namespace {

// The launches that follow each other on a device of this many samples a second.
void expectBounded(double samplesPerSecond, bool isSoftware) {
    const double limit = launchSeconds(isSoftware);
    LaunchSize size(isSoftware, 50);
    double seconds = 0;
    for (int i = 0; i < 12; ++i) {
        const std::uint64_t samples = size.suggest();
        seconds = static_cast<double>(samples) / samplesPerSecond;
        if (i > 0) {
            EXPECT_LE(seconds, limit) << i << ", " << samplesPerSecond;
        }
        size.measured(samples, seconds);
    }
    EXPECT_GE(seconds, 0.87 * limit) << samplesPerSecond;
    EXPECT_NEAR(size.secondsFor(size.suggest()), seconds, 1e-3 * limit);
    // A device that becomes slow is noticed at once, and what is left of a pass misleads nobody.
    const std::uint64_t samples = size.suggest();
    size.measured(samples, 5 * seconds);
    EXPECT_LE(static_cast<double>(size.suggest()), 0.21 * static_cast<double>(samples));
    const std::uint64_t before = size.suggest();
    size.measured(1, 1e-5);
    EXPECT_EQ(size.suggest(), before);
}

TEST(LaunchesTest, FitTheTimeOfFastAndSlowDevices) {
    for (const double rate : {1e7, 1e9, 2e10}) expectBounded(rate, false);
    for (const double rate : {1e5, 1e6}) expectBounded(rate, true);
}

} // namespace
} // namespace rt::gpu
