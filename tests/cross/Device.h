// The Vulkan device that the tests run on: $RT_DEVICE or the best. Tests fail where there is none.
#pragma once
#include <string>

#include <gtest/gtest.h>

#include "Common/Render/Names.h"
#include "Common/Vulkan/VulkanContext.h"

namespace rt::test {

// With validation, synchronization included; lives until the last test has ended.
vulkan::VulkanContext& device();

// Whether it lacks that engine; the test asserts that it is refused then.
bool lacks(app::GpuEngineKind engine);

// Both ways to trace rays on it, as parameters of tests.
inline const auto kBothEngines = ::testing::Values(app::GpuEngineKind::Pipeline, app::GpuEngineKind::Compute);

// One proves a formula, which both compile from one header, or what the host does for both alike. The other one's proof
// has the prefix Nightly, by which ctest leaves it to the nightly tests; that its images are right, too, EstimatorsTest
// proves with every change.
inline const auto kFirstEngine = ::testing::Values(app::GpuEngineKind::Compute);
inline const auto kSecondEngine = ::testing::Values(app::GpuEngineKind::Pipeline);

// Whether the engine is that of nightly tests, which try what takes a driver's compiler long.
inline bool isNightly(app::GpuEngineKind engine) {
    return engine == app::GpuEngineKind::Pipeline;
}

inline std::string engineName(const ::testing::TestParamInfo<app::GpuEngineKind>& info) {
    return app::nameOf(app::kGpuEngines, info.param);
}

} // namespace rt::test
