// Memory barriers between commands that name what wrote and what reads or writes next.
#pragma once
#include <vulkan/vulkan.h>

namespace rt::vulkan {

// What some commands do with memory: in these stages of the pipeline, in these ways.
struct Access {
    VkPipelineStageFlags stages;
    VkAccessFlags access;
};

constexpr Access operator|(Access a, Access b) {
    return {a.stages | b.stages, a.access | b.access};
}

inline constexpr Access kTransferRead{VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT};
inline constexpr Access kTransferWrite{VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT};
inline constexpr Access kHostRead{VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT};
inline constexpr Access kComputeRead{VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT};
inline constexpr Access kComputeWrite{VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT};
inline constexpr Access kFragmentRead{VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT};
// Of acceleration structures and of scratch memory.
inline constexpr Access kStructureRead{VK_PIPELINE_STAGE_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
                                       VK_ACCESS_ACCELERATION_STRUCTURE_READ_BIT_KHR};
inline constexpr Access kStructureWrite{VK_PIPELINE_STAGE_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
                                        VK_ACCESS_ACCELERATION_STRUCTURE_WRITE_BIT_KHR};
inline constexpr Access kStructureTrace{VK_PIPELINE_STAGE_RAY_TRACING_SHADER_BIT_KHR,
                                        VK_ACCESS_ACCELERATION_STRUCTURE_READ_BIT_KHR};
inline constexpr Access kStructureQuery{VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                                        VK_ACCESS_ACCELERATION_STRUCTURE_READ_BIT_KHR};

// Commands behind it do `after` once those before it, of earlier submissions as well, have done `before` and what they
// wrote can be seen.
inline void barrier(VkCommandBuffer commands, Access before, Access after) {
    VkMemoryBarrier memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    memory.srcAccessMask = before.access;
    memory.dstAccessMask = after.access;
    vkCmdPipelineBarrier(commands, before.stages, after.stages, 0, 1, &memory, 0, nullptr, 0, nullptr);
}

} // namespace rt::vulkan
