// Every built-in scene, every way of sampling lights: the GPU's image with its own random numbers against the CPU's.
#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Image/ImageTest.h"
#include "Common/Scene/BuiltinScenes.h"
#include "Common/Scene/SceneCompiler.h"
#include "RayTracingCPU/CpuEngine.h"
#include "RayTracingGPU/GpuEngine.h"
#include "tests/cross/Device.h"

namespace rt::test {
namespace {

constexpr std::uint32_t kBlocks = 32;
constexpr std::uint32_t kSide = 16;
constexpr std::uint32_t kSpp = 16;

// Images of independent seeds.
std::vector<image::Image> blocks(app::Engine& engine, const scene::CompiledScene& scene, app::LightSampling sampling,
                                 std::uint32_t firstSeed) {
    std::vector<image::Image> images;
    for (std::uint32_t i = 0; i < kBlocks; ++i) {
        app::RenderSettings settings;
        settings.width = settings.height = kSide;
        settings.spp = kSpp;
        settings.sampler = app::SamplerKind::Independent;
        settings.lightSampling = sampling;
        settings.seed = firstSeed + i;
        engine.reset(scene.camera, settings);
        while (!engine.renderSome({std::chrono::seconds(1), nullptr}).finished) {
        }
        images.push_back(engine.film().resolve());
    }
    EXPECT_EQ(engine.report().nonfiniteSamples, 0u) << scene.id;
    return images;
}

class EstimatorsTest : public ::testing::TestWithParam<std::size_t> {};

// Bias that this can see: 4 standard errors of the difference, stated on failure; a tile that is some per cent off is a
// discovery. Seeds are fixed.
TEST_P(EstimatorsTest, EnginesAgree) {
    const scene::BuiltinScene& builtin = scene::builtinScenes()[GetParam()];
    std::string id(builtin.id);
    if (builtin.defaultCount > 200) id += ":200";
    scene::CompileOptions options;
    options.generatedAssets = true;
    const auto compiled = scene::compileScene(scene::findBuiltinScene(id), options);
    const auto gpu = gpu::makeGpuEngine(
        device(), {.pipelineCache = false, .engine = app::GpuEngineKind::Pipeline});
    const auto cpu = cpu::makeCpuEngine({});
    gpu->setScene(compiled, nullptr);
    cpu->setScene(compiled, nullptr);
    for (const auto sampling : {app::LightSampling::Bsdf, app::LightSampling::Mixture, app::LightSampling::Mis}) {
        const auto result =
            image::testImages(blocks(*gpu, *compiled, sampling, 5000), blocks(*cpu, *compiled, sampling, 6000));
        SCOPED_TRACE(static_cast<int>(sampling));
        EXPECT_GT(result.globalP, 1e-4) << result.summary();
        EXPECT_EQ(result.tileDiscoveries, 0u) << result.summary();
    }
    EXPECT_EQ(device().validationMessages(), 0u);
}

std::string sceneName(const ::testing::TestParamInfo<std::size_t>& info) {
    std::string name(scene::builtinScenes()[info.param].id);
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Scenes, EstimatorsTest, ::testing::Range(std::size_t{0}, scene::builtinScenes().size()),
                         sceneName);

} // namespace
} // namespace rt::test
