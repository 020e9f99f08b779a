// The stability suite that ray-tracing-bench prints, asserted on the device.
#include "RayTracingGPU/GpuEngine.h"
#include "tests/cross/Device.h"
#include "tests/image/Harness.h"

namespace rt::test {
namespace {

class StabilityTest : public ::testing::TestWithParam<app::GpuEngineKind> {};
// Its forty scenes are as many pipelines, and they pass on the CPU (tests/image) through the same text at every change.
INSTANTIATE_TEST_SUITE_P(Nightly, StabilityTest, kBothEngines, engineName);

TEST_P(StabilityTest, EveryRowPasses) {
    const auto engine = gpu::makeGpuEngine(device(), {.pipelineCache = false, .engine = GetParam()});
    expectStability(*engine);
}

} // namespace
} // namespace rt::test
