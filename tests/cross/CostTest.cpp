// What pixels cost: as many rays as the render of the same samples traces, and time where the device has a clock.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "RayTracingGPU/GpuEngine.h"
#include "tests/cross/Device.h"

namespace rt::test {
namespace {

constexpr std::uint32_t kCostSide = 20, kSamples = 8;

class CostTest : public ::testing::TestWithParam<app::GpuEngineKind> {
  protected:
    // Seen from so far that a box is surrounded by nothing. False where the device lacks the engine.
    bool start(const char* name, const app::RenderSettings& settings) {
        if (lacks(GetParam())) return false;
        const auto scene = app::compile(app::loadScene(name), true);
        scene::CameraDesc camera = scene->camera;
        camera.verticalFov *= 1.6;
        engine_ = gpu::makeGpuEngine(device(), {.pipelineCache = false, .engine = GetParam()});
        engine_->setScene(scene, nullptr);
        engine_->reset(camera, settings);
        return true;
    }
    static app::RenderSettings settings() {
        app::RenderSettings settings;
        settings.width = settings.height = kCostSide;
        settings.spp = kSamples;
        return settings;
    }
    static float median(std::vector<float> values) {
        std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
        return values[values.size() / 2];
    }
    std::unique_ptr<app::Engine> engine_;
};
INSTANTIATE_TEST_SUITE_P(Engines, CostTest, kFirstEngine, engineName);
INSTANTIATE_TEST_SUITE_P(Nightly, CostTest, kSecondEngine, engineName);
INSTANTIATE_TEST_SUITE_P(Queries, CostTest, ::testing::Values(app::GpuEngineKind::Query), engineName);

TEST_P(CostTest, RaysAreThoseOfTheRender) {
    app::RenderSettings s = settings();
    // Drivers take long over the samplers by projected solid angle.
    if (isNightly(GetParam())) s.sphereLight = s.quadLight = app::ShapeSampling::Projected;
    // What a ray meets after the first vertex depends on its place in the pixel where mirrors show lamps as spots.
    if (!start("veach-mis", s)) return;
    while (!engine_->renderSome({}).finished) continue;
    const app::RayCounts rays = engine_->report().rays;
    EXPECT_GT(rays.edge, 0u);
    const image::Image costs = engine_->renderCost(app::Cost::Rays, kSamples);
    double sum = 0;
    for (const float cost : costs.data) sum += std::round(static_cast<double>(cost) * kSamples);
    EXPECT_EQ(sum, static_cast<double>(rays.all() - rays.reuse));
}

TEST_P(CostTest, PixelsOfLongPathsTakeLonger) {
    if (!start("next-week-cornell-box", settings())) return;
    EXPECT_EQ(engine_->knowsCost(app::Cost::Time), device().info().hasShaderClock);
    const image::Image times = engine_->renderCost(app::Cost::Time, kSamples);
    if (!device().info().hasShaderClock) {
        EXPECT_TRUE(times.data.empty());
        return;
    }
    const image::Image rays = engine_->renderCost(app::Cost::Rays, kSamples);
    std::vector<float> empty, inside;
    for (std::size_t i = 0; i < times.data.size(); ++i) {
        EXPECT_GT(times.data[i], 0);
        (rays.data[i] == 1 ? empty : inside).push_back(times.data[i]);
    }
    ASSERT_GT(empty.size(), 20u);
    ASSERT_GT(inside.size(), 20u);
    EXPECT_GT(median(inside), median(empty));
}

} // namespace
} // namespace rt::test
