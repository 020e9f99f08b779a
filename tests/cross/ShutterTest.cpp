// Motion blur on the GPU: the picture of the CPU engine, within the noise of both.
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Render/ShutterEngine.h"
#include "RayTracingGPU/GpuEngine.h"
#include "tests/TempFolder.h"
#include "tests/cross/Device.h"
#include "tests/image/Harness.h"
#include "tests/unit/MovingModels.h"
#include "tests/unit/Statistics.h"

namespace rt::test {
namespace {

// Of each column, over seeds.
std::vector<Mean> columnMeans(std::unique_ptr<app::Engine> engine, const app::PoseScene& pose) {
    constexpr std::uint32_t kSeeds = 4;
    const auto blurred = app::makeShutterEngine(std::move(engine), 0, 1, pose);
    const auto scene = pose(0.5);
    blurred->setScene(scene, nullptr);
    app::RenderSettings settings = smallSettings(8, 8);
    settings.replicates = 2;
    std::vector<Mean> means(settings.width);
    for (settings.seed = 0; settings.seed < kSeeds; ++settings.seed) {
        const image::Image picture = renderImage(*blurred, *scene, settings);
        for (std::uint32_t x = 0; x < settings.width; ++x) {
            double sum = 0;
            for (std::uint32_t y = 0; y < settings.height; ++y) sum += double{picture.pixel(x, y)[1]};
            means[x].add(sum / settings.height);
        }
    }
    return means;
}

class ShutterOnDevice : public ::testing::TestWithParam<app::GpuEngineKind> {};

// Both take the same samples at the same times: what rounding makes of them is far less than their noise.
TEST_P(ShutterOnDevice, AgreesWithTheCpuEngine) {
    if (lacks(GetParam())) return;
    const TempFolder folder;
    const app::PoseScene pose = app::posesOf({scene::saveMovingLamp(folder / "lamp.glb").string()});
    const std::vector<Mean> cpu = columnMeans(cpu::makeCpuEngine({}), pose);
    const std::vector<Mean> gpu =
        columnMeans(gpu::makeGpuEngine(device(), {.pipelineCache = false, .engine = GetParam()}), pose);
    double covered = 0;
    for (std::size_t x = 0; x < cpu.size(); ++x) {
        covered += cpu[x].mean() / static_cast<double>(cpu.size());
        EXPECT_NEAR(gpu[x].mean(), cpu[x].mean(), 1e-3 + 0.25 * cpu[x].standardError()) << "column " << x;
    }
    EXPECT_NEAR(covered, 0.25, 0.02); // a lamp of width 0.5 in a picture of width 2, of which it stays inside
}

INSTANTIATE_TEST_SUITE_P(Engines, ShutterOnDevice, kBothEngines, engineName);

} // namespace
} // namespace rt::test
