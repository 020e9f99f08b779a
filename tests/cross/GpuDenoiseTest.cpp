// Denoised pictures of films that an engine has on its device, against those that the processor makes of them.
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Image/Denoise/FilmHalves.h"
#include "Common/Image/Metrics.h"
#include "Common/Render/PictureDenoiser.h"
#include "RayTracingGPU/GpuEngine.h"
#include "tests/cross/Device.h"

namespace rt::test {
namespace {

const std::atomic<bool> kNever{false};

class GpuDenoiseTest : public ::testing::Test {
  protected:
    std::unique_ptr<app::Engine> start(bool adaptive = false) {
        app::RenderSettings& settings = settings_;
        settings.width = 52;
        settings.height = 37;
        settings.spp = adaptive ? 64 : 8;
        settings.sppIsKnown = true;
        settings.replicates = 2;
        settings.adaptive = adaptive;
        const auto scene = scene_ = app::compile(app::loadScene("cornell-box-lights"), true);
        auto engine = gpu::makeGpuEngine(
            device(),
            {.pipelineCache = false, .engine = app::GpuEngineKind::Compute, .denoisesInSoftware = inSoftware_});
        engine->setScene(scene, nullptr);
        engine->reset(scene->camera, settings);
        return engine;
    }
    bool inSoftware_ = true;
    app::RenderSettings settings_;
    std::shared_ptr<const scene::CompiledScene> scene_;
    static void finish(app::Engine& engine) {
        while (!engine.renderSome({}).finished) continue;
    }
    static void expectTheSame(app::Engine& engine, const app::DenoiseRequest& request) {
        const auto got = engine.makeDenoiser()->denoise(request, kNever);
        const auto expected = app::makeHostDenoiser(engine)->denoise(request, kNever);
        ASSERT_TRUE(got && expected);
        EXPECT_EQ(got->quality, request.quality);
        EXPECT_FALSE(got->device.empty());
        EXPECT_TRUE(expected->device.empty());
        EXPECT_LE(image::compare(got->images.picture, expected->images.picture).relmse, 1e-4);
        EXPECT_EQ(got->images.halfA.data.size(), expected->images.halfA.data.size());
    }
};

TEST_F(GpuDenoiseTest, FiltersTheFilmWhereItIs) {
    const auto engine = start();
    const std::atomic<bool> now{true};
    const auto before = engine->report().deviceBytes;
    EXPECT_FALSE(engine->makeDenoiser()->denoise({}, kNever)); // there are no samples
    EXPECT_GT(engine->report().deviceBytes, before);
    EXPECT_TRUE(engine->makeDenoiser()->isQuick()); // the film need not be copied
    finish(*engine);
    expectTheSame(*engine, {app::DenoiseQuality::Live, false, 1});
    expectTheSame(*engine, {app::DenoiseQuality::Final, true, app::kAovSamples});
    EXPECT_FALSE(engine->makeDenoiser()->denoise({}, now));
}

TEST_F(GpuDenoiseTest, FiltersAnAdaptiveFilm) {
    const auto engine = start(true);
    finish(*engine);
    ASSERT_TRUE(engine->film().hasPlan());
    expectTheSame(*engine, {});
}

TEST_F(GpuDenoiseTest, LeavesItToTheProcessorWhereThatIsTheDevice) {
    inSoftware_ = false;
    const auto engine = start();
    finish(*engine);
    const app::DenoisedPicture got = engine->denoiseHalves(image::filmHalves(engine->film()), false, 1);
    EXPECT_EQ(got.device.empty(), device().info().isSoftware());
    EXPECT_EQ(engine->makeDenoiser()->isQuick(), !device().info().isSoftware());
}

// What --denoise asks for.
TEST_F(GpuDenoiseTest, FiltersHalvesOfTheHost) {
    const auto engine = start();
    finish(*engine);
    const image::DenoiseInput input = image::filmHalves(engine->film());
    const app::DenoisedPicture got = engine->denoiseHalves(input, false, 1);
    const app::DenoisedPicture expected = engine->Engine::denoiseHalves(input, false, 1);
    EXPECT_EQ(got.device, device().info().name);
    EXPECT_FALSE(got.passes.empty());
    EXPECT_TRUE(expected.device.empty());
    EXPECT_TRUE(got.images.error.data.empty());
    EXPECT_LE(image::compare(got.images.picture, expected.images.picture).relmse, 1e-4);
    EXPECT_NEAR(got.images.relmse.value, expected.images.relmse.value, 0.02 * expected.images.relmse.value);
}

// What --denoise asks for where the picture is whole: features that the host never has, of the camera that is there.
TEST_F(GpuDenoiseTest, MakesFeaturesOnTheDevice) {
    const auto engine = start();
    finish(*engine);
    const image::DenoiseInput halves = image::filmHalves(engine->film());
    const auto expectOwnFeatures = [&] {
        image::DenoiseInput input = halves;
        app::AovRequest request{{true, true, true}};
        request.isAdaptive = true;
        app::AovImages features = engine->renderAovs(request, app::kAovSamples);
        input.albedo = std::move(features.albedo);
        input.normal = std::move(features.normal);
        input.depth = std::move(features.depth);
        const std::optional<app::DenoisedPicture> got = engine->denoiseWhole(halves, false);
        ASSERT_TRUE(got);
        const image::Image expected = engine->Engine::denoiseHalves(input, false, 1).images.picture;
        EXPECT_LE(image::compare(got->images.picture, expected).relmse, 1e-4);
    };
    expectOwnFeatures();
    const image::Image first = engine->denoiseWhole(halves, false)->images.picture;
    engine->denoiseHalves(halves, false, 1); // which have none
    EXPECT_EQ(engine->denoiseWhole(halves, false)->images.picture.data, first.data);
    scene::CameraDesc camera = scene_->camera;
    camera.verticalFov /= 2;
    engine->reset(camera, settings_);
    expectOwnFeatures();
    EXPECT_NE(engine->denoiseWhole(halves, false)->images.picture.data, first.data);
}

TEST_F(GpuDenoiseTest, LeavesFeaturesToTheHostWhereTheProcessorIsTheDevice) {
    inSoftware_ = false;
    const auto engine = start();
    finish(*engine);
    EXPECT_EQ(engine->denoiseWhole(image::filmHalves(engine->film()), false).has_value(),
              !device().info().isSoftware());
}

} // namespace
} // namespace rt::test
