// First-hit features of an image.
#pragma once
#include "Common/Render/Engine.h"
#include "Common/Vulkan/VulkanContext.h"
#include "RayTracingGPU/Kernel.h"

namespace rt::gpu {

// Averages over the first `samples` samples of each pixel.
app::AovImages renderAovPass(vulkan::VulkanContext& context, const Kernel& kernel, std::uint32_t width,
                             std::uint32_t height, const app::AovRequest& request, std::uint32_t samples);

} // namespace rt::gpu
