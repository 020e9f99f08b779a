#include "tests/cross/Device.h"

#include <cstdlib>

#include <gtest/gtest.h>

#include "Common/Vulkan/Check.h"
#include "RayTracingGPU/EngineChoice.h"
#include "RayTracingGPU/GpuEngine.h"
#include "tests/cross/SharedPipelines.h"

namespace rt::test {
namespace {

// Whatever the tests did, the validation layers have nothing to say about it.
class NoValidationMessages : public ::testing::Environment {
  public:
    void TearDown() override { EXPECT_EQ(device().validationMessages(), 0u); }
};

const auto* const kEnvironment = ::testing::AddGlobalTestEnvironment(new NoValidationMessages);

} // namespace

vulkan::VulkanContext& device() {
    const char* chosen = std::getenv("RT_DEVICE");
    static SharingContext context({chosen != nullptr ? chosen : "", true});
    return context;
}

bool lacks(app::GpuEngineKind engine) {
    if (device().info().serves(gpu::neededBy(engine))) return false;
    EXPECT_THROW(gpu::makeGpuEngine(device(), {.pipelineCache = false, .engine = engine}), vulkan::NoDeviceError);
    return true;
}

} // namespace rt::test
