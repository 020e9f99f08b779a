#include "RayTracingGPU/GpuEngine.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "Common/Core/Error.h"
#include "Common/Render/PictureDenoiser.h"
#include "Common/Render/RenderParams.h"
#include "Common/Scene/CameraRecord.h"
#include "Common/Shared/Base/Features.h"
#include "Common/Vulkan/Check.h"
#include "Common/Vulkan/PipelineCache.h"
#include "Common/Vulkan/ShaderFigures.h"
#include "RayTracingGPU/AovPass.h"
#include "RayTracingGPU/EngineChoice.h"
#include "RayTracingGPU/FilmRenderer.h"
#include "RayTracingGPU/GpuDenoiser.h"
#include "RayTracingGPU/GpuScene.h"
#include "RayTracingGPU/MeasuredEngine.h"
#include "RayTracingGPU/PixelPass.h"
#include "RayTracingGPU/PreviewPass.h"
#include "RayTracingGPU/RenderKernels.h"
#include "Shaders/Records.h"

namespace rt::gpu {
namespace {

class GpuEngine final : public app::Engine, private FilmOnDevice {
  public:
    GpuEngine(vulkan::VulkanContext& context, const GpuEngineOptions& options)
        : context_(context),
          options_(options),
          cache_(context, options.pipelineCache ? vulkan::pipelineCacheFile(context) : ""),
          engine_(options.engine),
          kernels_(context, cache_, engine_),
          renderer_(context, cache_, options_, engine_, kernels_, report_) {}

    bool setScene(std::shared_ptr<const scene::CompiledScene> compiled, const std::atomic<bool>* cancel) override {
        auto prepared = std::make_unique<GpuScene>(context_, engine_, std::move(compiled), cancel, scene_.get());
        if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) return false;
        preview_.reset();
        scene_ = std::move(prepared);
        isNewScene_ = true;
        return true;
    }

    void reset(const scene::CameraDesc& camera, const app::RenderSettings& settings) override;
    void resetForLeases(const scene::CameraDesc& camera, const app::RenderSettings& settings) override;
    void restore(image::Film film) override { renderer_.setFilm(std::move(film)); }
    void renderOnly(image::TileList tiles, std::uint32_t spp, std::span<const std::byte> packed) override {
        renderer_.renderOnly(std::move(tiles), spp, packed);
    }
    app::RenderStatus renderSome(const app::Budget& budget) override { return renderer_.renderSome(budget); }
    const image::Film& film() override { return renderer_.film(); }
    app::TilesToPack takeTiles(const image::TileList& tiles) override;
    app::Snapshot snapshot() override;
    app::AovImages renderAovs(const app::AovRequest& request, std::uint32_t samples) override;
    bool knowsCost(app::Cost cost) const override { return cost == app::Cost::Rays || context_.info().hasShaderClock; }
    image::Image renderCost(app::Cost cost, std::uint32_t samples) override;
    bool canPreview() const override { return context_.info().draws; }
    app::Preview renderPreview(const scene::CameraDesc& camera, std::uint32_t width, std::uint32_t height) override;
    std::unique_ptr<app::PictureDenoiser> makeDenoiser() override;
    app::DenoisedPicture denoiseHalves(const image::DenoiseInput& halves, bool details, std::uint32_t threads) override;
    std::optional<app::DenoisedPicture> denoiseWhole(const image::DenoiseInput& halves, bool details) override;
    app::EngineReport report() const override;

  private:
    bool denoises() const { return !context_.info().isSoftware() || options_.denoisesInSoftware; }
    GpuDenoiser& denoiser() override;
    std::uint32_t dependentSide() const override { return app::dependentSide(features_); }
    std::uint64_t resolveHalves(const vulkan::Buffer& to) override { return renderer_.resolveHalves(to); }
    std::uint64_t resolveOne(const vulkan::Buffer& to) override { return renderer_.resolveOne(to); }
    bool renderSurfaces(std::uint32_t samples, const vulkan::Buffer& to, const std::atomic<bool>& cancel) override;
    // Not where the device fails.
    std::optional<app::DenoisedPicture> denoiseOnDevice(const image::DenoiseInput& halves, bool details,
                                                        FilmOnDevice* surfaces);

    void adopt(const scene::CameraDesc& camera, const app::RenderSettings& settings);
    void makeReady(const scene::CameraDesc& camera);

    vulkan::VulkanContext& context_;
    GpuEngineOptions options_;
    vulkan::PipelineCache cache_;
    app::GpuEngineKind engine_; // not Auto
    RenderKernels kernels_;
    app::EngineReport report_;
    FilmRenderer renderer_;
    std::optional<GpuDenoiser> denoiser_; // once it was needed

    std::unique_ptr<GpuScene> scene_;
    bool isNewScene_ = false;            // since the last reset
    std::optional<PreviewPass> preview_; // of the scene, once it was asked for
    app::RenderSettings settings_;
    shared::Camera camera_{};
    shared::RenderParams params_{};
    shared::Features features_;
};

void GpuEngine::reset(const scene::CameraDesc& camera, const app::RenderSettings& settings) {
    adopt(camera, settings);
    renderer_.setFilm(image::Film(app::filmDesc(settings)));
    makeReady(camera);
}

void GpuEngine::resetForLeases(const scene::CameraDesc& camera, const app::RenderSettings& settings) {
    adopt(camera, settings);
    renderer_.setPart(image::Film::part(app::filmDesc(settings)));
    makeReady(camera);
}

void GpuEngine::adopt(const scene::CameraDesc& camera, const app::RenderSettings& settings) {
    features_ = app::renderFeatures(scene_->compiled(), camera, settings);
    if (shared::has(features_, shared::kFeatureMovingSpheres)) scene_->provideMotion(context_);
    settings_ = settings;
    params_ = app::makeRenderParams(scene_->compiled(), settings);
    renderer_.adopt(settings_, features_, shared::reusesPaths(features_, params_));
    camera_ = scene::makeCamera(camera, settings.width, settings.height, scene_->compiled().origin);
    if (!denoiser_) return;
    if (isNewScene_) denoiser_->history().forget();
    denoiser_->begin(camera_, settings);
}

void GpuEngine::makeReady(const scene::CameraDesc& camera) {
    const std::optional<double> seconds = kernels_.prepare(*scene_, camera, settings_, features_, params_);
    if (seconds) report_.pipelineSeconds = *seconds;
    renderer_.makeReady(isNewScene_ || seconds);
    isNewScene_ = false;
    report_.rays = {};
    report_.nonfiniteSamples = 0;
    report_.cutOff = 0;
    report_.renderDeviceSeconds = 0;
}

app::TilesToPack GpuEngine::takeTiles(const image::TileList& tiles) {
    if (std::optional<app::TilesToPack> taken = renderer_.takeTiles(tiles)) return std::move(*taken);
    return Engine::takeTiles(tiles);
}

app::Snapshot GpuEngine::snapshot() {
    if (std::optional<app::Snapshot> taken = renderer_.snapshot()) return std::move(*taken);
    return Engine::snapshot();
}

app::AovImages GpuEngine::renderAovs(const app::AovRequest& request, std::uint32_t samples) {
    return renderAovPass(context_, kernels_.firstHits(), settings_.width, settings_.height, request, samples);
}

image::Image GpuEngine::renderCost(app::Cost cost, std::uint32_t samples) {
    if (!knowsCost(cost)) return {};
    const auto kernel = kernels_.make(cost == app::Cost::Time ? KernelPurpose::Time : KernelPurpose::Rays);
    image::Image costs(settings_.width, settings_.height, 1);
    runPixelPass(context_, *kernel, {settings_.width, settings_.height, settings_.maxDepth, std::max(samples, 1u), 1},
                 [&](std::span<const float> values, std::size_t first) {
                     std::copy(values.begin(), values.end(), &costs.data[first]);
                 });
    return costs;
}

app::Preview GpuEngine::renderPreview(const scene::CameraDesc& camera, std::uint32_t width, std::uint32_t height) {
    if (!canPreview()) return {};
    if (!preview_) {
        preview_.emplace(context_, cache_, *scene_);
        cache_.save();
    }
    return preview_->render(camera, width, height);
}

std::unique_ptr<app::PictureDenoiser> GpuEngine::makeDenoiser() {
    if (!denoises()) return Engine::makeDenoiser();
    return makeFilmDenoiser(*this, *this, settings_.width, settings_.height);
}

GpuDenoiser& GpuEngine::denoiser() {
    if (!denoiser_) {
        denoiser_.emplace(context_, cache_);
        denoiser_->begin(camera_, settings_);
    }
    return *denoiser_;
}

bool GpuEngine::renderSurfaces(std::uint32_t samples, const vulkan::Buffer& to, const std::atomic<bool>& cancel) {
    PixelPass pass{settings_.width, settings_.height, 1, samples, shared::kSurfaceValues, shared::kSeenTogether};
    pass.isAdaptive = true;
    return runPixelPass(context_, kernels_.firstHits(), pass, to, cancel);
}

// The processor does it where the device fails, as for want of memory: it has the halves.
app::DenoisedPicture GpuEngine::denoiseHalves(const image::DenoiseInput& halves, bool details, std::uint32_t threads) {
    if (auto made = denoiseOnDevice(halves, details, nullptr)) return std::move(*made);
    return Engine::denoiseHalves(halves, details, threads);
}

std::optional<app::DenoisedPicture> GpuEngine::denoiseWhole(const image::DenoiseInput& halves, bool details) {
    return denoiseOnDevice(halves, details, this);
}

std::optional<app::DenoisedPicture> GpuEngine::denoiseOnDevice(const image::DenoiseInput& halves, bool details,
                                                               FilmOnDevice* surfaces) {
    if (!denoises() || renderer_.hasFailed()) return std::nullopt;
    try {
        return denoiser().denoise(halves, dependentSide(), details, surfaces);
    } catch (const vulkan::DeviceLostError&) {
        renderer_.giveUpDevice();
    } catch (const RenderError&) {
        denoiser_.reset();
    }
    return std::nullopt;
}

app::EngineReport GpuEngine::report() const {
    app::EngineReport report = report_;
    report.engine = app::nameOf(app::kGpuEngines, engine_);
    report.device = context_.info().name;
    report.isSoftware = context_.info().isSoftware();
    report.features = features_;
    report.lightSampling = app::describeLightShapes(settings_, features_);
    if (const Kernel* paths = kernels_.paths()) {
        report.kernel = paths->name();
        for (const vulkan::ShaderFigure& figure : vulkan::shaderFigures(context_, paths->pipeline()))
            report.shaders.push_back({figure.shader, figure.name, figure.value});
    }
    if (scene_) report.accelBuildSeconds = scene_->buildSeconds();
    report.deviceBytes = context_.memory().deviceBytes();
    report.longestDispatchSeconds = context_.longestRun();
    return report;
}

} // namespace

std::unique_ptr<app::Engine> makeGpuEngine(vulkan::VulkanContext& context, const GpuEngineOptions& options) {
    requireEngine(options.engine, context.info());
    if (options.engine != app::GpuEngineKind::Auto) return std::make_unique<GpuEngine>(context, options);
    const std::vector<app::GpuEngineKind> engines = enginesOf(context.info());
    if (options.measures && engines.size() > 1) return makeMeasuredEngine(context, options);
    GpuEngineOptions named = options;
    named.engine = engines.back();
    return std::make_unique<GpuEngine>(context, named);
}

} // namespace rt::gpu
