#include "RayTracingGPU/CostPass.h"

#include <algorithm>
#include <span>

#include "Shaders/Records.h"

namespace rt::gpu {
namespace {

constexpr std::uint64_t kBandSamples = 1u << 17; // a launch stays short even on a slow device

}  // namespace

image::Image renderCostPass(vulkan::VulkanContext& context, const Kernel& kernel, std::uint32_t width,
                            std::uint32_t height, std::uint32_t samples) {
    image::Image rays(width, height, 1);
    const std::uint64_t bandPixels = std::max<std::uint64_t>(kBandSamples / samples, 1);
    const auto bandRows = static_cast<std::uint32_t>(std::max<std::uint64_t>(1, bandPixels / width));
    const vulkan::Buffer buffer(context, std::uint64_t{width} * bandRows * sizeof(float), 0, vulkan::Memory::Device,
                                "costs");
    for (std::uint32_t row = 0; row < height; row += bandRows) {
        const std::uint32_t rows = std::min(bandRows, height - row);
        const std::uint32_t pixels = width * rows;
        const shared::AovLaunch launch{buffer.address(), row, pixels, samples};
        context.run([&](VkCommandBuffer commands) {
            kernel.launch(commands, launch, pixels);
            vulkan::barrier(commands);
        });
        const std::span<float> band(rays.pixel(0, row), pixels);
        vulkan::download(context, buffer, std::as_writable_bytes(band));
    }
    return rays;
}

}  // namespace rt::gpu
