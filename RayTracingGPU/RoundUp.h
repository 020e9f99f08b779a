#pragma once
#include <vulkan/vulkan.h>

namespace rt::gpu {

// To a multiple of `alignment`.
constexpr VkDeviceSize roundUp(VkDeviceSize value, VkDeviceSize alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

} // namespace rt::gpu
