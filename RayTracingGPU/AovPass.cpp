#include "RayTracingGPU/AovPass.h"

#include <algorithm>
#include <span>

#include "RayTracingGPU/PixelPass.h"
#include "Shaders/Records.h"

namespace rt::gpu {
namespace {

// Values `from` and following of each pixel, into an image unless that is not wanted.
void copyValues(std::span<const float> values, std::uint32_t from, std::size_t firstPixel, image::Image& image) {
    if (image.data.empty()) return;
    for (std::size_t i = 0; i < values.size() / shared::kAovValues; ++i)
        std::copy_n(&values[i * shared::kAovValues + from], image.channels,
                    &image.data[(firstPixel + i) * image.channels]);
}

void copySurfaces(std::span<const float> values, std::uint32_t from, std::size_t firstPixel,
                  app::SurfaceImages& images) {
    copyValues(values, from, firstPixel, images.albedo);
    copyValues(values, from + 3, firstPixel, images.normal);
    copyValues(values, from + 6, firstPixel, images.depth);
}

} // namespace

app::AovImages renderAovPass(vulkan::VulkanContext& context, const Kernel& kernel, std::uint32_t width,
                             std::uint32_t height, const app::AovRequest& request, std::uint32_t samples) {
    app::AovImages images = app::makeAovImages(request, width, height);
    PixelPass pass{width, request.rows > 0 ? request.rows : height, 1, samples, shared::kAovValues, request.firstRow};
    pass.looksThrough = request.looksThrough();
    runPixelPass(context, kernel, pass, [&](std::span<const float> values, std::size_t first) {
        copySurfaces(values, shared::kFirstValues, first, images);
        copySurfaces(values, shared::kWideValues, first, images.wide);
        copyValues(values, shared::kEmissionValues, first, images.emission);
    });
    return images;
}

} // namespace rt::gpu
