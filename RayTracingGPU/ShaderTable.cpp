#include "RayTracingGPU/ShaderTable.h"

#include <cstring>

#include "Common/Vulkan/Check.h"
#include "Common/Vulkan/StagingRing.h"
#include "RayTracingGPU/RoundUp.h"

namespace rt::gpu {

ShaderTable::ShaderTable(vulkan::VulkanContext& context, VkPipeline pipeline, const ShaderGroups& groups)
    : cmdTraceRays_(context.rayTracing().cmdTraceRays) {
    const vulkan::DeviceLimits& limits = context.limits();
    const VkDeviceSize handleSize = limits.groupHandleSize;
    const VkDeviceSize base = limits.groupBaseAlignment;
    const VkDeviceSize stride = roundUp(handleSize, limits.groupHandleAlignment);
    // The one record of ray generation is as long as its stride and begins at a base address, as do the others' first
    // ones. A single miss record serves both kinds of rays: that nothing was hit means the same to both.
    const VkDeviceSize rayGenerationSize = roundUp(stride, base);
    const VkDeviceSize missSize = roundUp(stride, base);
    const VkDeviceSize hitStart = rayGenerationSize + missSize;
    const VkDeviceSize size = hitStart + stride * groups.hit.size();

    std::vector<std::byte> handles(handleSize * groups.count);
    vulkan::check(context.rayTracing().getGroupHandles(context.device(), pipeline, 0, groups.count, handles.size(),
                                                       handles.data()),
                  "Reading shader group handles");
    std::vector<std::byte> table(size);
    const auto place = [&](VkDeviceSize at, std::optional<std::uint32_t> group) {
        if (group) std::memcpy(&table[at], &handles[*group * handleSize], handleSize);
    };
    place(0, groups.rayGeneration);
    place(rayGenerationSize, groups.miss);
    for (std::size_t i = 0; i < groups.hit.size(); ++i) place(hitStart + i * stride, groups.hit[i]);

    buffer_ = vulkan::deviceArray<std::byte>(context, table, "the shader binding table",
                                             VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR, base);
    const VkDeviceAddress start = buffer_.address();
    rayGeneration_ = {start, rayGenerationSize, rayGenerationSize};
    miss_ = {start + rayGenerationSize, stride, stride};
    hit_ = {start + hitStart, stride, stride * groups.hit.size()};
}

void ShaderTable::trace(VkCommandBuffer commands, std::uint32_t invocations) const {
    const VkStridedDeviceAddressRegionKHR noCallables{};
    cmdTraceRays_(commands, &rayGeneration_, &miss_, &hit_, &noCallables, invocations, 1, 1);
}

} // namespace rt::gpu
