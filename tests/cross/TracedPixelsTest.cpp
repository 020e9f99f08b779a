// A pixel's samples that are traced again are those that the GPU takes, until rounding makes a path decide differently.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

#include "Common/Probe/PixelPaths.h"
#include "RayTracingGPU/GpuEngine.h"
#include "tests/cross/BoxRender.h"
#include "tests/cross/Device.h"

namespace rt::test {
namespace {

TEST(TracedPixelsTest, AreThoseOfTheGpu) {
    app::RenderSettings settings;
    settings.width = settings.height = 24;
    settings.spp = 1;
    BoxRender render(settings,
                     gpu::makeGpuEngine(device(), {.pipelineCache = false, .engine = app::GpuEngineKind::Compute}));
    const image::Image picture = render.finish().resolve();
    app::Options options;
    options.settings = settings;
    options.size = {settings.width, settings.height, {}};
    const probe::SceneFormulas formulas(render.scene, options, 0.0);
    std::size_t agreeing = 0;
    for (std::uint32_t y = 0; y < settings.height; ++y)
        for (std::uint32_t x = 0; x < settings.width; ++x) {
            const glm::vec3 traced = probe::PixelPaths(formulas, render.scene->camera, x, y).trace(0).radiance;
            bool isSame = true;
            for (int c = 0; c < 3; ++c)
                isSame = isSame && std::abs(traced[c] - picture.pixel(x, y)[c]) <=
                                       1e-3f * std::max(traced[c], picture.pixel(x, y)[c]) + 1e-6f;
            agreeing += isSame ? 1 : 0;
        }
    EXPECT_GE(static_cast<double>(agreeing), 0.97 * settings.width * settings.height); // glass is in sight
}

} // namespace
} // namespace rt::test
