// The Vulkan device that the tests run on: $RT_DEVICE or the best. Tests fail where there is none.
#pragma once
#include "Common/Vulkan/VulkanContext.h"

namespace rt::test {

// With validation, synchronization included; lives as long as the program.
vulkan::VulkanContext& device();

}  // namespace rt::test
