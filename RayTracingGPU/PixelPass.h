// Runs a kernel that goes through samples of pixels over rows of an image, in launches as short as a window needs them.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "Common/Vulkan/Buffer.h"
#include "Common/Vulkan/VulkanContext.h"
#include "RayTracingGPU/Kernel.h"

namespace rt::gpu {

struct PixelPass {
    std::uint32_t width = 0, rows = 0;
    std::uint32_t maxDepth = 1; // rays of a path, as far as the kernel follows it
    std::uint32_t samples = 1;  // of a pixel
    std::uint32_t values = 1;   // of a pixel that are written: floats
    std::uint32_t run = 1;      // pixels of an invocation
    std::uint32_t firstRow = 0; // of the image
    bool looksThrough = false;  // of features of surfaces, as PixelLaunch's
    bool isAdaptive = false;
};

// Writes the values of the pixels, row by row, to the buffer. False: cancelled. Throws RenderError.
bool runPixelPass(vulkan::VulkanContext& context, const Kernel& kernel, const PixelPass& pass, const vulkan::Buffer& to,
                  const std::atomic<bool>& cancel);

// Hands the values of the pixels, row by row, to `take` in pieces, with the number of each piece's first pixel from
// that of the first row. Throws RenderError.
void runPixelPass(vulkan::VulkanContext& context, const Kernel& kernel, const PixelPass& pass,
                  const std::function<void(std::span<const float> values, std::size_t firstPixel)>& take);

} // namespace rt::gpu
