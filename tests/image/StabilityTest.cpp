// The stability suite that ray-tracing-bench prints, asserted on the CPU.
#include <gtest/gtest.h>

#include "RayTracingCPU/CpuEngine.h"
#include "tests/image/Harness.h"

namespace rt::test {
namespace {

TEST(Stability, EveryRowPasses) {
    const auto engine = cpu::makeCpuEngine({});
    expectStability(*engine);
}

} // namespace
} // namespace rt::test
