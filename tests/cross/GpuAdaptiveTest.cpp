// Adaptive sampling on the GPU: the same bits however work is cut, from any film, and the plan that the CPU makes.
#include <algorithm>
#include <chrono>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Image/SamplePlan.h"
#include "RayTracingGPU/GpuEngine.h"
#include "tests/cross/BoxRender.h"
#include "tests/cross/Device.h"
#include "tests/image/Harness.h"

namespace rt::test {
namespace {

using namespace std::chrono_literals;
using image::Film;

constexpr std::uint32_t kAdaptiveSide = 20; // no multiple of a tile's

app::RenderSettings adaptiveSettings(std::uint32_t spp) {
    app::RenderSettings settings;
    settings.width = settings.height = kAdaptiveSide;
    settings.spp = spp;
    settings.replicates = 2;
    settings.adaptive = true;
    return settings;
}

class GpuAdaptive : public ::testing::TestWithParam<app::GpuEngineKind> {};
INSTANTIATE_TEST_SUITE_P(Engines, GpuAdaptive, kBothEngines, engineName);

gpu::GpuEngineOptions adaptiveEngine() {
    gpu::GpuEngineOptions options;
    options.pipelineCache = false;
    options.engine = GpuAdaptive::GetParam();
    return options;
}

BoxRender gpuRender(const app::RenderSettings& settings, const gpu::GpuEngineOptions& options = adaptiveEngine()) {
    return {settings, gpu::makeGpuEngine(device(), options)};
}

TEST_P(GpuAdaptive, NeitherPartsNorLaunchesShow) {
    const app::RenderSettings settings = adaptiveSettings(36);
    BoxRender whole = gpuRender(settings);
    const std::vector<float> expected = whole.finish().resolve().data;
    for (const std::uint32_t slots : {6u, gpu::GpuEngineOptions().regionSlots})
        for (const double seconds : {1e-9, 0.1}) {
            gpu::GpuEngineOptions options = adaptiveEngine();
            options.regionSlots = slots;
            options.launchSeconds = seconds;
            BoxRender parts = gpuRender(settings, options);
            const Film& film = parts.finish();
            EXPECT_TRUE(sameBits(expected, film.resolve().data)) << slots << ", " << seconds;
            EXPECT_EQ(film.totalSamples(), std::uint64_t{kAdaptiveSide} * kAdaptiveSide * settings.spp);
            EXPECT_EQ(parts.engine->report().rays.camera, std::uint64_t{kAdaptiveSide} * kAdaptiveSide * settings.spp);
        }
}

// Also what a window shows, which the device resolves.
TEST_P(GpuAdaptive, GoesOnFromAFilmInAnyPhase) {
    const app::RenderSettings settings = adaptiveSettings(64);
    BoxRender whole = gpuRender(settings);
    const std::vector<float> expected = whole.finish().resolve().data;
    gpu::GpuEngineOptions options = adaptiveEngine();
    options.launchSeconds = 1e-9;
    BoxRender slow = gpuRender(settings, options);
    std::vector<Film> films;
    bool wasPlanned = false;
    for (int slice = 0; !slow.engine->renderSome({0s, nullptr}).finished; ++slice) {
        const bool isPlanned = slow.engine->film().hasPlan();
        if (slice == 5 || (isPlanned && !wasPlanned)) films.push_back(slow.engine->film());
        wasPlanned = isPlanned;
    }
    films.push_back(slow.engine->film());
    ASSERT_EQ(films.size(), 3u);
    for (Film& film : films) {
        BoxRender resumed = gpuRender(settings);
        resumed.engine->restore(std::move(film));
        EXPECT_TRUE(sameBits(expected, resumed.finish().resolve().data));
        const app::Snapshot snapshot = resumed.engine->snapshot();
        for (std::size_t i = 0; i < expected.size(); ++i)
            EXPECT_NEAR(snapshot.radiance.data[i], expected[i], 1e-6f * expected[i]) << i;
    }
}

// From the film of the CPU engine's pilot it goes on as the CPU engine does.
TEST_P(GpuAdaptive, ThePlanIsThatOfTheCpu) {
    const app::RenderSettings settings = adaptiveSettings(64);
    BoxRender cpu(settings, cpu::makeCpuEngine({}));
    while (cpu.engine->film().nextSample(image::pilotSamples(settings.spp)) != Film::kNoSample)
        cpu.engine->renderSome({0s, nullptr});
    Film pilot = cpu.engine->film();
    ASSERT_TRUE(pilot.isPilot());
    BoxRender gpu = gpuRender(settings);
    gpu.engine->restore(std::move(pilot));
    const std::vector<float> counts = gpu.finish().sampleCounts().data;
    EXPECT_EQ(counts, cpu.finish().sampleCounts().data);
    const auto [minimum, maximum] = std::minmax_element(counts.begin(), counts.end());
    EXPECT_LT(2 * *minimum, *maximum);
}

} // namespace
} // namespace rt::test
