// Every built-in scene, every way of sampling lights: the GPU's images with their own random numbers against the CPU's.
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "RayTracingCPU/CpuEngine.h"
#include "RayTracingGPU/GpuEngine.h"
#include "tests/SceneCases.h"
#include "tests/cross/Device.h"
#include "tests/image/Harness.h"
#include "tests/image/ImageEquivalence.h"

namespace rt::test {
namespace {

constexpr std::uint32_t kEstimateSide = 16;
constexpr std::uint32_t kSpp = 16;

constexpr app::LightSampling kEstimators[] = {app::LightSampling::Bsdf, app::LightSampling::Mixture,
                                              app::LightSampling::Mis};

// A scene by its index, and its estimators.
struct SceneAndEstimators {
    std::size_t scene = 0;
    std::vector<app::LightSampling> estimators;
};
class EstimatorsTest : public ::testing::TestWithParam<SceneAndEstimators> {};

// Bias that this can see: 4 standard errors of the difference, stated on failure; a tile that is some per cent off is a
// discovery. Seeds are fixed. The CPU's image is the one of least variance: that all its estimators agree, tests/image
// proves.
TEST_P(EstimatorsTest, EnginesAgree) {
    const scene::BuiltinScene& builtin = scene::builtinScenes()[GetParam().scene];
    scene::CompileOptions options;
    options.generatedAssets = true;
    const auto compiled = scene::compileScene(scene::findBuiltinScene(smallSceneId(builtin)), options);
    const auto gpu = gpu::makeGpuEngine(device(), {.pipelineCache = false, .engine = app::GpuEngineKind::Pipeline});
    const auto cpu = cpu::makeCpuEngine({});
    gpu->setScene(compiled, nullptr);
    cpu->setScene(compiled, nullptr);
    const auto reference = independentImages(*cpu, *compiled, app::LightSampling::Mis, kEstimateSide, kSpp, 6000);
    for (const app::LightSampling sampling : GetParam().estimators) {
        const auto result =
            image::testImages(independentImages(*gpu, *compiled, sampling, kEstimateSide, kSpp, 5000), reference);
        SCOPED_TRACE(static_cast<int>(sampling));
        EXPECT_GT(result.globalP, 1e-4) << result.summary();
        EXPECT_EQ(result.tileDiscoveries, 0u) << result.summary();
    }
    EXPECT_EQ(device().validationMessages(), 0u);
}

std::string builtinName(const ::testing::TestParamInfo<SceneAndEstimators>& info) {
    return caseName(std::string(scene::builtinScenes()[info.param.scene].id));
}

// The CPU's estimators are compared with each other, and the engines path by path: a quarter of the scenes, each with
// the next of the estimators, suffices at every change. Nightly tests have the rest.
std::vector<SceneAndEstimators> scenesOf(bool nightly) {
    std::vector<SceneAndEstimators> scenes;
    for (std::size_t i = 0; i < scene::builtinScenes().size(); ++i) {
        SceneAndEstimators all{i, {std::begin(kEstimators), std::end(kEstimators)}};
        const bool isTried = i % 4 == 0;
        const app::LightSampling next = kEstimators[i / 4 % std::size(kEstimators)];
        if (isTried && nightly) std::erase(all.estimators, next);
        if (isTried && !nightly) all.estimators = {next};
        if (isTried || nightly) scenes.push_back(std::move(all));
    }
    return scenes;
}
INSTANTIATE_TEST_SUITE_P(Scenes, EstimatorsTest, ::testing::ValuesIn(scenesOf(false)), builtinName);
INSTANTIATE_TEST_SUITE_P(Nightly, EstimatorsTest, ::testing::ValuesIn(scenesOf(true)), builtinName);

} // namespace
} // namespace rt::test
