#include "tests/cross/Device.h"

#include <cstdlib>
#include <optional>

#include <gtest/gtest.h>

#include "Common/Vulkan/Check.h"
#include "RayTracingGPU/EngineChoice.h"
#include "RayTracingGPU/GpuEngine.h"
#include "tests/cross/SharedPipelines.h"

namespace rt::test {
namespace {

std::optional<SharingContext> sharedContext;

// Whatever the tests did, the validation layers have nothing to say about it. The device ends with the tests, not with
// the program's other objects: by then layers may have taken down what they need for it.
class EndOfDevice : public ::testing::Environment {
  public:
    void TearDown() override {
        if (!sharedContext) return;
        EXPECT_EQ(sharedContext->validationMessages(), 0u);
        sharedContext.reset();
    }
};

const auto* const kEnvironment = ::testing::AddGlobalTestEnvironment(new EndOfDevice);

} // namespace

vulkan::VulkanContext& device() {
    const char* chosen = std::getenv("RT_DEVICE");
    if (!sharedContext) sharedContext.emplace(vulkan::ContextOptions{chosen != nullptr ? chosen : "", true});
    return *sharedContext;
}

bool lacks(app::GpuEngineKind engine) {
    if (device().info().serves(gpu::neededBy(engine))) return false;
    EXPECT_THROW(gpu::makeGpuEngine(device(), {.pipelineCache = false, .engine = engine}), vulkan::NoDeviceError);
    return true;
}

} // namespace rt::test
