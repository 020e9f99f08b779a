#pragma once
#include <cstdint>
#include <optional>

#include <vulkan/vulkan.h>

namespace rt::vulkan {

// Index of the first type of memory among `allowed` (a bit each) with all wanted properties.
inline std::optional<std::uint32_t> findMemoryType(const VkPhysicalDeviceMemoryProperties& memory,
                                                   std::uint32_t allowed, VkMemoryPropertyFlags wanted) {
    for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
        const bool isAllowed = (allowed >> i & 1u) != 0;
        if (isAllowed && (memory.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
    }
    return std::nullopt;
}

} // namespace rt::vulkan
