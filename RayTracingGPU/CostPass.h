// What each pixel of an image costs, band by band.
#pragma once
#include "Common/Image/Image.h"
#include "RayTracingGPU/Kernel.h"

namespace rt::gpu {

// Rays, averaged over the first `samples` samples of each pixel.
image::Image renderCostPass(vulkan::VulkanContext& context, const Kernel& kernel, std::uint32_t width,
                            std::uint32_t height, std::uint32_t samples);

}  // namespace rt::gpu
