// The stability suite that ray-tracing-bench prints, asserted on the device.
#include "Common/Bench/Stability.h"
#include "RayTracingGPU/GpuEngine.h"
#include "tests/cross/Device.h"

namespace rt::test {
namespace {

class StabilityTest : public ::testing::TestWithParam<app::GpuEngineKind> {};
INSTANTIATE_TEST_SUITE_P(Engines, StabilityTest, kBothEngines, engineName);

TEST_P(StabilityTest, EveryRowPasses) {
    const auto engine = gpu::makeGpuEngine(device(), {.pipelineCache = false, .engine = GetParam()});
    const auto rows = bench::measureStability(*engine);
    EXPECT_GE(rows.size(), 40u);
    for (const bench::StabilityRow& row : rows)
        EXPECT_TRUE(row.pass) << row.name << ": " << row.value << ", must be " << row.criterion;
}

} // namespace
} // namespace rt::test
