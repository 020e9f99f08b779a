#include "RayTracingGPU/AovPass.h"

#include <algorithm>
#include <span>
#include <vector>

#include "Shaders/Records.h"

namespace rt::gpu {
namespace {

constexpr std::uint64_t kBandSamples = 1u << 20; // a launch stays short even on a slow device
constexpr std::uint64_t kBandPixels = 1u << 20;

void copyPixels(std::span<const float> values, std::size_t firstPixel, app::AovImages& images) {
    for (std::size_t i = 0; i < values.size() / shared::kAovValues; ++i) {
        const float* pixel = &values[i * shared::kAovValues];
        const std::size_t at = firstPixel + i;
        if (!images.albedo.data.empty()) std::copy_n(pixel, 3, &images.albedo.data[3 * at]);
        if (!images.normal.data.empty()) std::copy_n(pixel + 3, 3, &images.normal.data[3 * at]);
        if (!images.depth.data.empty()) images.depth.data[at] = pixel[6];
    }
}

}  // namespace

app::AovImages renderAovPass(vulkan::VulkanContext& context, const Kernel& kernel, std::uint32_t width, std::uint32_t height,
                             const app::AovRequest& request, std::uint32_t samples) {
    app::AovImages images;
    if (request.albedo) images.albedo = image::Image(width, height, 3);
    if (request.normal) images.normal = image::Image(width, height, 3);
    if (request.depth) images.depth = image::Image(width, height, 1);

    const std::uint64_t bandPixels = std::clamp(kBandSamples / samples, std::uint64_t{1}, kBandPixels);
    const auto bandRows = static_cast<std::uint32_t>(std::max<std::uint64_t>(1, bandPixels / width));
    std::vector<float> values(std::size_t{width} * bandRows * shared::kAovValues);
    const vulkan::Buffer buffer(context, values.size() * sizeof(float), 0, vulkan::Memory::Device, "features");
    for (std::uint32_t row = 0; row < height; row += bandRows) {
        const std::uint32_t rows = std::min(bandRows, height - row);
        const std::uint32_t pixels = width * rows;
        const shared::AovLaunch launch{buffer.address(), row, pixels, samples};
        context.run([&](VkCommandBuffer commands) {
            kernel.launch(commands, launch, pixels);
            vulkan::barrier(commands);
        });
        const std::span<float> band = std::span(values).first(std::size_t{pixels} * shared::kAovValues);
        vulkan::download(context, buffer, std::as_writable_bytes(band));
        copyPixels(band, std::size_t{row} * width, images);
    }
    return images;
}

}  // namespace rt::gpu
