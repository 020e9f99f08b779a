// What each pixel of an image costs.
#pragma once
#include "Common/Image/Image.h"
#include "Common/Vulkan/VulkanContext.h"
#include "RayTracingGPU/Kernel.h"

namespace rt::gpu {

// Rays or ticks, as the kernel counts them, averaged over the first `samples` samples of each pixel.
image::Image renderCostPass(vulkan::VulkanContext& context, const Kernel& kernel, std::uint32_t width,
                            std::uint32_t height, std::uint32_t maxDepth, std::uint32_t samples);

} // namespace rt::gpu
