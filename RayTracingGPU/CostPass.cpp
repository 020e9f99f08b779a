#include "RayTracingGPU/CostPass.h"

#include <algorithm>
#include <span>

#include "RayTracingGPU/PixelPass.h"

namespace rt::gpu {

image::Image renderCostPass(vulkan::VulkanContext& context, const Kernel& kernel, std::uint32_t width,
                            std::uint32_t height, std::uint32_t maxDepth, std::uint32_t samples) {
    image::Image costs(width, height, 1);
    runPixelPass(context, kernel, {width, height, maxDepth, samples, 1},
                 [&](std::span<const float> values, std::size_t first) {
                     std::copy(values.begin(), values.end(), &costs.data[first]);
                 });
    return costs;
}

} // namespace rt::gpu
