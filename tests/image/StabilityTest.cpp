// The stability suite that ray-tracing-bench prints, asserted on the CPU. What it can detect is in its criteria.
#include <gtest/gtest.h>

#include "Common/Bench/Stability.h"
#include "RayTracingCPU/CpuEngine.h"

namespace rt::test {
namespace {

TEST(Stability, EveryRowPasses) {
    const auto engine = cpu::makeCpuEngine({});
    const auto rows = bench::measureStability(*engine);
    EXPECT_GE(rows.size(), 40u);
    for (const bench::StabilityRow& row : rows)
        EXPECT_TRUE(row.pass) << row.name << ", " << row.engine << ": " << row.value << ", must be " << row.criterion;
}

} // namespace
} // namespace rt::test
