// The shader binding table: which group of a pipeline runs for a ray's start, miss and hit, and for a call.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "Common/Vulkan/Buffer.h"
#include "Common/Vulkan/VulkanContext.h"

namespace rt::gpu {

// Indices of a pipeline's groups. A record without a group is never reached.
struct ShaderGroups {
    std::uint32_t rayGeneration = 0;
    std::uint32_t miss = 0;
    std::vector<std::optional<std::uint32_t>> hit;
    std::uint32_t count = 0; // of groups
};

class ShaderTable {
  public:
    ShaderTable(vulkan::VulkanContext& context, VkPipeline pipeline, const ShaderGroups& groups);

    // Runs this many invocations of the ray generation shader.
    void trace(VkCommandBuffer commands, std::uint32_t invocations) const;

  private:
    PFN_vkCmdTraceRaysKHR cmdTraceRays_;
    vulkan::Buffer buffer_;
    VkStridedDeviceAddressRegionKHR rayGeneration_{};
    VkStridedDeviceAddressRegionKHR miss_{};
    VkStridedDeviceAddressRegionKHR hit_{};
};

} // namespace rt::gpu
