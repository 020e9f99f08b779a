// Runs a kernel of one invocation a pixel over an image, in launches as short as a window needs them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "Common/Vulkan/VulkanContext.h"
#include "RayTracingGPU/Kernel.h"

namespace rt::gpu {

struct PixelPass {
    std::uint32_t width = 0, height = 0;
    std::uint32_t maxDepth = 1; // rays of a path, as far as the kernel follows it
    std::uint32_t samples = 1;  // that an invocation takes
    std::uint32_t values = 1;   // that it writes: floats
};

// Hands the values of the pixels, row by row, to `take` in pieces, with the number of each piece's first pixel. Throws
// RenderError.
void runPixelPass(vulkan::VulkanContext& context, const Kernel& kernel, const PixelPass& pass,
                  const std::function<void(std::span<const float> values, std::size_t firstPixel)>& take);

} // namespace rt::gpu
