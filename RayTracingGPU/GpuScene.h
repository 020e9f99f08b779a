// The compiled scene on the device.
#pragma once
#include <memory>

#include "Common/Scene/CompiledScene.h"
#include "Common/Vulkan/VulkanResources.h"
#include "RayTracingGPU/AccelStructure.h"
#include "Shaders/Records.h"

namespace rt::gpu {

// The arrays that exist, and the acceleration structure over them. Immutable.
class GpuScene {
  public:
    // Uploads and builds. Throws RenderError.
    GpuScene(vulkan::VulkanContext& context, std::shared_ptr<const scene::CompiledScene> compiled);

    // A superset of the scene's features may look for motion where there is none: sets it to zero.
    void provideMotion(vulkan::VulkanContext& context);

    const scene::CompiledScene& compiled() const { return *compiled_; }
    const shared::SceneArrays& arrays() const { return arrays_; }
    const AccelStructure& accel() const { return *accel_; }

  private:
    template <class T>
    std::uint64_t add(vulkan::VulkanContext& context, const std::vector<T>& data, const char* name,
                      VkBufferUsageFlags usage = 0);

    std::shared_ptr<const scene::CompiledScene> compiled_;
    std::vector<vulkan::Buffer> buffers_;
    shared::SceneArrays arrays_{};
    std::unique_ptr<AccelStructure> accel_;
};

}  // namespace rt::gpu
