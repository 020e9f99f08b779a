#include "RayTracingGPU/AovPass.h"

#include <algorithm>
#include <span>

#include "RayTracingGPU/PixelPass.h"
#include "Shaders/Records.h"

namespace rt::gpu {
namespace {

// What a pass has written of pixels, from this one on.
struct AovValues {
    std::span<const float> values;
    std::uint32_t ofPixel = 0;
    std::size_t firstPixel = 0;
};

// Values `from` and following of each pixel, into an image unless that is not wanted.
void copyValues(const AovValues& pixels, std::uint32_t from, image::Image& image) {
    if (image.data.empty()) return;
    for (std::size_t i = 0; i < pixels.values.size() / pixels.ofPixel; ++i)
        std::copy_n(&pixels.values[i * pixels.ofPixel + from], image.channels,
                    &image.data[(pixels.firstPixel + i) * image.channels]);
}

void copySurfaces(const AovValues& pixels, std::uint32_t from, app::SurfaceImages& images) {
    copyValues(pixels, from, images.albedo);
    copyValues(pixels, from + 3, images.normal);
    copyValues(pixels, from + 6, images.depth);
}

} // namespace

app::AovImages renderAovPass(vulkan::VulkanContext& context, const Kernel& kernel, std::uint32_t width,
                             std::uint32_t height, const app::AovRequest& request, std::uint32_t samples) {
    app::AovImages images = app::makeAovImages(request, width, height);
    PixelPass pass{width, request.rows > 0 ? request.rows : height, 1, samples};
    pass.run = shared::kSeenTogether;
    pass.firstRow = request.firstRow;
    pass.looksThrough = request.looksThrough();
    pass.isAdaptive = request.isAdaptive;
    pass.values = shared::aovValues(pass.looksThrough);
    runPixelPass(context, kernel, pass, [&](std::span<const float> values, std::size_t first) {
        const AovValues pixels{values, pass.values, first};
        copySurfaces(pixels, shared::kFirstValues, images);
        if (!pass.looksThrough) return;
        copySurfaces(pixels, shared::kWideValues, images.wide);
        copyValues(pixels, shared::kEmissionValues, images.emission);
    });
    return images;
}

} // namespace rt::gpu
