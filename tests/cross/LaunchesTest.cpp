// Launches are as long as they may be and no longer, once it is known how fast a device is.
#include <gtest/gtest.h>

#include "RayTracingGPU/Launches.h"

namespace rt::gpu {
namespace {

// The launches that follow each other on a device of this many samples a second.
void expectBounded(double budget, double samplesPerSecond, bool isSoftware) {
    LaunchSize size(isSoftware, 50);
    double seconds = 0;
    for (int i = 0; i < 12; ++i) {
        const std::uint64_t samples = size.suggest(budget);
        seconds = static_cast<double>(samples) / samplesPerSecond;
        if (i > 0) {
            EXPECT_LE(seconds, 1.001 * budget) << i << ", " << samplesPerSecond;
        }
        size.measured(samples, seconds);
    }
    const double share = budget < kLaunchSeconds ? 0.86 : 0.9; // short ones keep a reserve
    EXPECT_GE(seconds, share * budget) << samplesPerSecond;
    // A device that becomes slow is noticed at once, and what is left of a pass misleads nobody.
    const std::uint64_t samples = size.suggest(budget);
    size.measured(samples, 5 * seconds);
    EXPECT_LE(static_cast<double>(size.suggest(budget)), 0.21 * static_cast<double>(samples));
    const std::uint64_t before = size.suggest(budget);
    size.measured(1, 1e-5);
    EXPECT_EQ(size.suggest(budget), before);
}

TEST(LaunchesTest, FitTheBudgetOfFastAndSlowDevices) {
    for (const double budget : {kWindowLaunchSeconds, kLaunchSeconds}) {
        for (const double rate : {1e7, 1e9, 2e10}) expectBounded(budget, rate, false);
        for (const double rate : {1e5, 1e6}) expectBounded(budget, rate, true);
    }
    LaunchSize size(false, 50);
    EXPECT_EQ(size.suggest(10), size.suggest(kLaunchSeconds)); // never longer
}

} // namespace
} // namespace rt::gpu
