// The stability suite that ray-tracing-bench prints, asserted on the device.
#include "RayTracingGPU/GpuEngine.h"
#include "tests/cross/Device.h"
#include "tests/image/Harness.h"

namespace rt::test {
namespace {

class StabilityTest : public ::testing::TestWithParam<app::GpuEngineKind> {};
INSTANTIATE_TEST_SUITE_P(Engines, StabilityTest, kFirstEngine, engineName);
INSTANTIATE_TEST_SUITE_P(Nightly, StabilityTest, kSecondEngine, engineName);

// Every estimator's weights are finite on the CPU (tests/image) and are the same on both (EstimatorAgreementTest): all
// of them are tried on the device by nightly tests.
TEST_P(StabilityTest, EveryRowPasses) {
    const auto engine = gpu::makeGpuEngine(device(), {.pipelineCache = false, .engine = GetParam()});
    expectStability(*engine, isNightly(GetParam()));
}

} // namespace
} // namespace rt::test
