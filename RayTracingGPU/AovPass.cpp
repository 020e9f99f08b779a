#include "RayTracingGPU/AovPass.h"

#include <algorithm>
#include <span>

#include "RayTracingGPU/PixelPass.h"
#include "Shaders/Records.h"

namespace rt::gpu {
namespace {

void copyPixels(std::span<const float> values, std::size_t firstPixel, app::AovImages& images) {
    for (std::size_t i = 0; i < values.size() / shared::kAovValues; ++i) {
        const float* pixel = &values[i * shared::kAovValues];
        const std::size_t at = firstPixel + i;
        if (!images.albedo.data.empty()) std::copy_n(pixel, 3, &images.albedo.data[3 * at]);
        if (!images.normal.data.empty()) std::copy_n(pixel + 3, 3, &images.normal.data[3 * at]);
        if (!images.depth.data.empty()) images.depth.data[at] = pixel[6];
    }
}

} // namespace

app::AovImages renderAovPass(vulkan::VulkanContext& context, const Kernel& kernel, std::uint32_t width,
                             std::uint32_t height, const app::AovRequest& request, std::uint32_t samples) {
    app::AovImages images;
    const std::uint32_t rows = request.rows > 0 ? request.rows : height;
    if (request.albedo) images.albedo = image::Image(width, rows, 3);
    if (request.normal) images.normal = image::Image(width, rows, 3);
    if (request.depth) images.depth = image::Image(width, rows, 1);
    runPixelPass(context, kernel, {width, rows, 1, samples, shared::kAovValues, request.firstRow},
                 [&](std::span<const float> values, std::size_t first) { copyPixels(values, first, images); });
    return images;
}

} // namespace rt::gpu
