// Every built-in scene, every way of sampling lights: the GPU's images with their own random numbers against the CPU's.
#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Image/ImageTest.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "RayTracingCPU/CpuEngine.h"
#include "RayTracingGPU/GpuEngine.h"
#include "tests/cross/Device.h"
#include "tests/image/Harness.h"

namespace rt::test {
namespace {

constexpr std::uint32_t kEstimateSide = 16;
constexpr std::uint32_t kSpp = 16;

class EstimatorsTest : public ::testing::TestWithParam<std::size_t> {};

// Bias that this can see: 4 standard errors of the difference, stated on failure; a tile that is some per cent off is a
// discovery. Seeds are fixed. The CPU's image is the one of least variance: that all its estimators agree, tests/image
// proves.
TEST_P(EstimatorsTest, EnginesAgree) {
    const scene::BuiltinScene& builtin = scene::builtinScenes()[GetParam()];
    std::string id(builtin.id);
    if (builtin.defaultCount > 200) id += ":200";
    scene::CompileOptions options;
    options.generatedAssets = true;
    const auto compiled = scene::compileScene(scene::findBuiltinScene(id), options);
    const auto gpu = gpu::makeGpuEngine(device(), {.pipelineCache = false, .engine = app::GpuEngineKind::Pipeline});
    const auto cpu = cpu::makeCpuEngine({});
    gpu->setScene(compiled, nullptr);
    cpu->setScene(compiled, nullptr);
    const auto reference = independentImages(*cpu, *compiled, app::LightSampling::Mis, kEstimateSide, kSpp, 6000);
    for (const auto sampling : {app::LightSampling::Bsdf, app::LightSampling::Mixture, app::LightSampling::Mis}) {
        const auto result =
            image::testImages(independentImages(*gpu, *compiled, sampling, kEstimateSide, kSpp, 5000), reference);
        SCOPED_TRACE(static_cast<int>(sampling));
        EXPECT_GT(result.globalP, 1e-4) << result.summary();
        EXPECT_EQ(result.tileDiscoveries, 0u) << result.summary();
    }
    EXPECT_EQ(device().validationMessages(), 0u);
}

std::string builtinName(const ::testing::TestParamInfo<std::size_t>& info) {
    std::string name(scene::builtinScenes()[info.param].id);
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return name;
}

// The CPU's estimators are compared on all scenes, and the engines with each other on all: half of the scenes suffice at
// every change.
constexpr std::size_t kSecond = 2;
INSTANTIATE_TEST_SUITE_P(Scenes, EstimatorsTest,
                         ::testing::Range(std::size_t{0}, scene::builtinScenes().size(), kSecond), builtinName);
INSTANTIATE_TEST_SUITE_P(Nightly, EstimatorsTest,
                         ::testing::Range(std::size_t{1}, scene::builtinScenes().size(), kSecond), builtinName);

} // namespace
} // namespace rt::test
