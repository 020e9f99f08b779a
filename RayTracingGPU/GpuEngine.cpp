#include "RayTracingGPU/GpuEngine.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "Common/Core/Error.h"
#include "Common/Image/SamplePlan.h"
#include "Common/Render/RenderParams.h"
#include "Common/Render/Stopwatch.h"
#include "Common/Scene/CameraRecord.h"
#include "Common/Shared/Base/Features.h"
#include "Common/Vulkan/Check.h"
#include "Common/Vulkan/PipelineCache.h"
#include "Common/Vulkan/ShaderFigures.h"
#include "Common/Vulkan/StagingRing.h"
#include "RayTracingGPU/AovPass.h"
#include "RayTracingGPU/CostPass.h"
#include "RayTracingGPU/DeviceFilm.h"
#include "RayTracingGPU/EngineChoice.h"
#include "RayTracingGPU/GpuScene.h"
#include "RayTracingGPU/Kernels.h"
#include "RayTracingGPU/LaunchQueue.h"
#include "RayTracingGPU/Launches.h"
#include "RayTracingGPU/MeasuredEngine.h"
#include "RayTracingGPU/Pass.h"
#include "RayTracingGPU/PreviewPass.h"

namespace rt::gpu {
namespace {

using image::Film;
using vulkan::Memory;

class GpuEngine final : public app::Engine {
  public:
    GpuEngine(vulkan::VulkanContext& context, const GpuEngineOptions& options)
        : context_(context),
          options_(options),
          cache_(context, options.pipelineCache ? vulkan::pipelineCacheFile(context) : ""),
          engine_(options.engine),
          bindings_(context, engine_, std::max(sizeof(shared::PathLaunch), sizeof(shared::PixelLaunch))),
          uniforms_(context.memory(), sizeof(shared::RenderConstants), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                    Memory::Device, "constants"),
          launches_(context, cache_, {.invocations = maxInvocations(context, engine_), .samples = kMaxSamples}),
          readBacks_(context) {}

    bool setScene(std::shared_ptr<const scene::CompiledScene> compiled, const std::atomic<bool>* cancel) override {
        auto prepared = std::make_unique<GpuScene>(context_, engine_, std::move(compiled), cancel);
        if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) return false;
        preview_.reset();
        scene_ = std::move(prepared);
        launchSize_.reset();
        return true;
    }

    void reset(const scene::CameraDesc& camera, const app::RenderSettings& settings) override;
    void resetForLeases(const scene::CameraDesc& camera, const app::RenderSettings& settings) override;
    void restore(Film film) override { setFilm(std::move(film)); }
    void renderOnly(image::TileList tiles, std::uint32_t spp, std::span<const std::byte> packed) override;
    app::RenderStatus renderSome(const app::Budget& budget) override;
    const Film& film() override;
    app::TilesToPack takeTiles(const image::TileList& tiles) override;
    app::Snapshot snapshot() override;
    app::AovImages renderAovs(const app::AovRequest& request, std::uint32_t samples) override;
    bool knowsCost(app::Cost cost) const override { return cost == app::Cost::Rays || context_.info().hasShaderClock; }
    image::Image renderCost(app::Cost cost, std::uint32_t samples) override;
    bool canPreview() const override { return context_.info().draws; }
    app::Preview renderPreview(const scene::CameraDesc& camera, std::uint32_t width, std::uint32_t height) override;
    app::EngineReport report() const override;

  private:
    std::unique_ptr<Kernel> makeKernel(KernelPurpose purpose) const;
    void adopt(const scene::CameraDesc& camera, const app::RenderSettings& settings);
    void makeReady(const scene::CameraDesc& camera);
    void setFilm(Film film);
    void loadTiles();
    void uploadConstants(const scene::CameraDesc& camera);
    bool beginPass(const std::atomic<bool>* cancel);
    void launchNext();
    void beginLaunch(shared::FilmLaunch launch);
    void finishPaths();
    void endLaunch();
    void endLaunches();
    bool sharesPaths() const { return shared::reusesPaths(features_, params_); }
    LaunchKernels launchKernels() const { return {*kernel_, reuse_.get()}; }
    void planSamples(const std::atomic<bool>* cancel);
    bool nextRegion();
    void refresh();

    vulkan::VulkanContext& context_;
    GpuEngineOptions options_;
    vulkan::PipelineCache cache_;
    app::GpuEngineKind engine_; // not Auto
    RenderBindings bindings_;
    std::optional<FilmResolver> resolver_; // once it was needed
    vulkan::Buffer uniforms_;              // RenderConstants
    vulkan::Buffer edges_, edgeParts_;     // of lights, of which these tell
    LaunchQueue launches_;
    ReadBackPool readBacks_;

    std::unique_ptr<GpuScene> scene_;
    std::optional<PreviewPass> preview_; // of the scene, once it was asked for
    app::RenderSettings settings_;
    shared::RenderParams params_{};
    shared::Features features_;
    std::unique_ptr<Kernel> kernel_;
    std::unique_ptr<Kernel> reuse_;     // if samples share their paths
    std::unique_ptr<Kernel> firstHits_; // once it was asked for
    SpecializationConstants constants_; // that they were compiled for

    Film film_;                          // on the host: the whole film, or the part of a lease
    image::TileList tiles_;              // of it, that are to be rendered
    std::optional<std::uint32_t> limit_; // samples per pixel that renderOnly() has asked for
    std::unique_ptr<DeviceFilm> region_; // those on the device: all of them unless they are many; null before a lease
    bool dirty_ = false;                 // region_ is ahead of film_
    bool failed_ = false;                // the device did: nothing may be read from it any more
    app::Stopwatch sinceRefresh_;
    std::uint64_t samplesDone_ = 0;        // of the tiles, what region_ is ahead included
    std::uint64_t samplesTotal_ = 0;       // of the tiles, when they are done
    std::uint64_t begun_ = 0;              // samples per pixel that the passes so far lead to
    std::uint64_t goal_ = 0;               // that they lead to in the end, or before there is a plan
    std::optional<Pass> pass_;             // that is in progress
    std::optional<LaunchSize> launchSize_; // of this scene and pipeline
    app::EngineReport report_;
};

// ---- set-up --------------------------------------------------------------------------------------------------------

void GpuEngine::reset(const scene::CameraDesc& camera, const app::RenderSettings& settings) {
    adopt(camera, settings);
    setFilm(Film(app::filmDesc(settings)));
    makeReady(camera);
}

// Memory for tiles comes with the leases.
void GpuEngine::resetForLeases(const scene::CameraDesc& camera, const app::RenderSettings& settings) {
    adopt(camera, settings);
    film_ = Film::part(app::filmDesc(settings));
    tiles_.clear();
    region_ = nullptr;
    dirty_ = false;
    makeReady(camera);
}

void GpuEngine::adopt(const scene::CameraDesc& camera, const app::RenderSettings& settings) {
    features_ = app::renderFeatures(scene_->compiled(), camera, settings);
    if (shared::has(features_, shared::kFeatureMovingSpheres)) scene_->provideMotion(context_);
    if (settings.maxDepth > settings_.maxDepth) launchSize_.reset();
    settings_ = settings;
    params_ = app::makeRenderParams(scene_->compiled(), settings);
}

void GpuEngine::makeReady(const scene::CameraDesc& camera) {
    uploadConstants(camera);
    if (usesAccelStructure(engine_)) {
        bindings_.update(uniforms_, scene_->topLevel());
    } else {
        bindings_.update(uniforms_, scene_->linearLists());
    }

    TraversalShape traversal = scene_->shape();
    traversal.groupSize = groupSize(context_, features_);
    const SpecializationConstants constants =
        makeSpecializationConstants(features_, params_, scene_->compiled().globals.lightCount, traversal);
    if (!kernel_ || constants_ != constants || sharesPaths() != (reuse_ != nullptr)) {
        const app::Stopwatch watch;
        kernel_ = nullptr;
        reuse_ = nullptr;
        firstHits_ = nullptr;
        constants_ = constants;
        kernel_ = makeKernel(KernelPurpose::Paths);
        reuse_ = sharesPaths() ? makeKernel(KernelPurpose::Reuse) : nullptr;
        cache_.save();
        report_.pipelineSeconds = watch.seconds();
        launchSize_.reset();
    }
    if (!launchSize_) {
        launchSize_.emplace(context_.info().isSoftware(), settings_.maxDepth, options_.launchSeconds);
    }
    const std::uint64_t samples = std::uint64_t{settings_.width} * settings_.height * settings_.spp;
    launches_.prepare(context_.info().isDiscrete() ? samples : 0);
    report_.rays = {};
    report_.nonfiniteSamples = 0;
    report_.cutOff = 0;
    report_.renderDeviceSeconds = 0;
}

std::unique_ptr<Kernel> GpuEngine::makeKernel(KernelPurpose purpose) const {
    return gpu::makeKernel(context_, cache_, bindings_, engine_, purpose, constants_);
}

void GpuEngine::uploadConstants(const scene::CameraDesc& camera) {
    const scene::CompiledScene& s = scene_->compiled();
    shared::RenderConstants constants{};
    constants.arrays = scene_->arrays();
    constants.tree = scene_->tree();
    constants.globals = s.globals;
    constants.camera = scene::makeCamera(camera, settings_.width, settings_.height, s.origin);
    const scene::Silhouettes edges = app::splitAtEdges(s, constants.camera, settings_, params_);
    edges_ = vulkan::deviceArray<std::uint32_t>(context_, edges.bits(), "edges of lights");
    constants.edges = edges_.address();
    edgeParts_ = vulkan::deviceArray<std::uint32_t>(context_, edges.parts, "parts of pixels with edges");
    constants.edgeParts = edgeParts_.address();
    constants.params = params_;
    const std::size_t bounds = std::min<std::size_t>(s.lightBounds.size(), shared::kContributionLights);
    std::copy_n(s.lightBounds.begin(), bounds, constants.lightBounds);
    vulkan::upload(context_, uniforms_, std::as_bytes(std::span(&constants, 1)));
}

void GpuEngine::setFilm(Film film) {
    film_ = std::move(film);
    tiles_ = image::allTiles(film_);
    limit_.reset();
    loadTiles();
}

void GpuEngine::renderOnly(image::TileList tiles, std::uint32_t spp, std::span<const std::byte> packed) {
    if (film_.isPart()) {
        dirty_ = false; // what it had is forgotten
        film_.hold(tiles);
    } else {
        if (dirty_) refresh();
        if (tiles.size() < tiles_.size()) region_ = nullptr; // it has room for the others
    }
    image::unpackTiles(packed, film_);
    tiles_ = std::move(tiles);
    limit_ = spp;
    loadTiles();
}

void GpuEngine::loadTiles() {
    const auto count = static_cast<std::uint32_t>(std::max<std::size_t>(tiles_.size(), 1));
    const std::uint32_t tiles = std::min(count, std::max(1u, options_.regionSlots / settings_.replicates));
    if (!region_ || !region_->fits(film_, tiles, sharesPaths())) {
        region_ = nullptr; // its memory may be needed for the next one
        region_ = std::make_unique<DeviceFilm>(context_, film_.desc(), tiles, sharesPaths());
    }
    region_->load(film_, tiles_, 0);
    samplesDone_ = image::totalSamples(film_, tiles_);
    samplesTotal_ = limit_ ? samplesDone_ + image::missingSamples(film_, tiles_, *limit_)
                           : image::pixelCount(film_, tiles_) * settings_.spp;
    goal_ = limit_ ? *limit_ : image::goalOf(film_, settings_.spp);
    begun_ = image::nextSample(film_, tiles_, goal_);
    dirty_ = false;
    failed_ = false;
    pass_.reset();
    launches_.forget();
    sinceRefresh_ = {};
}

// ---- rendering -----------------------------------------------------------------------------------------------------

app::RenderStatus GpuEngine::renderSome(const app::Budget& budget) {
    if (!region_) throw RenderError("there was no memory for the film");
    const app::Stopwatch watch;
    const double seconds = budget.time.count();
    try {
        while (budget.cancel == nullptr || !budget.cancel->load(std::memory_order_relaxed)) {
            if (!pass_ && !beginPass(budget.cancel)) {
                finishPaths();
                break;
            }
            launchNext();
            if (watch.seconds() + launchSize_->secondsFor(launches_.samplesAhead()) >= seconds) break;
        }
        endLaunches();
        if (dirty_ && sinceRefresh_.seconds() > kRefreshSeconds) refresh();
    } catch (const vulkan::DeviceLostError&) {
        failed_ = true;
        launches_.drop();
        throw;
    } catch (...) {
        launches_.drop();
        throw;
    }
    app::RenderStatus status;
    status.samplesTotal = samplesTotal_;
    status.samplesDone = samplesDone_;
    status.finished = samplesDone_ >= samplesTotal_;
    return status;
}

// False: all is done or launched, or cancelled.
bool GpuEngine::beginPass(const std::atomic<bool>* cancel) {
    if (begun_ >= goal_ && !limit_ && film_.isPilot()) planSamples(cancel);
    if (tiles_.empty() || begun_ >= goal_) return false;
    if (region_->first() != 0) region_->load(film_, tiles_, 0);
    const std::uint64_t wanted = settings_.sppIsKnown ? launchSize_->samplesIn(options_.passSeconds) : 0;
    pass_ = planPass(*region_, begun_, goal_, launchSize_->suggest(), wanted, kMaxSamples);
    if (pass_->end % (shared::kBlock * settings_.replicates) != 0) region_->reserveOpenBlocks();
    return true;
}

// Decides on the samples of an adaptive film, whose pilot is done, and goes on with them.
void GpuEngine::planSamples(const std::atomic<bool>* cancel) {
    finishPaths();
    endLaunches();
    refresh();
    std::vector<std::uint32_t> plan =
        image::makeSamplePlan(film_, settings_.spp, app::dependentSide(features_), {.cancel = cancel});
    if (plan.empty()) return;
    film_.setPlan(std::move(plan));
    setFilm(std::move(film_));
}

// Behind the last launch of the last region the pass is over.
void GpuEngine::launchNext() {
    const shared::FilmLaunch launch = nextLaunch(*region_, *pass_, launchSize_->suggest(), kMaxSamples);
    beginLaunch(launch);
    pass_->nextSlot += launch.bandWidth;
    if (pass_->nextSlot == region_->bandSlots() && !nextRegion()) {
        begun_ = pass_->end;
        pass_.reset();
    }
}

void GpuEngine::beginLaunch(shared::FilmLaunch launch) {
    if (launches_.overlaps(launch)) finishPaths();
    launch.sampleCount = region_->numbersOf(launch);
    while (!launches_.hasRoom(launch, reuse_ != nullptr)) endLaunch();
    samplesDone_ += launches_.begin(launchKernels(), *region_, launch);
    dirty_ = true;
}

// Goes on with the paths that the last launch has left, and leaves none.
void GpuEngine::finishPaths() {
    if (!launches_.isUnfinished()) return;
    while (!launches_.hasRoom({}, false)) endLaunch();
    samplesDone_ += launches_.finish(launchKernels(), *region_);
    dirty_ = true;
}

// Waits for the end of the oldest launch that has not ended.
void GpuEngine::endLaunch() {
    const LaunchQueue::Ended ended = launches_.end();
    if (ended.samples != 0) launchSize_->measured(ended.samples, ended.seconds);
    report_.renderDeviceSeconds += ended.seconds;
    report_.rays += {ended.samples, ended.scattered, ended.shadow, ended.edgeRays, ended.reuse};
    report_.nonfiniteSamples += ended.nonfinite;
    report_.cutOff += ended.cutOff;
    if (ended.finished != ended.due) {
        failed_ = true; // what is on the device is not a film
        throw RenderError(context_.info().name + " ended a shader before its work was done (" +
                          std::to_string(ended.finished) + " of " + std::to_string(ended.due) +
                          " samples); a newer driver may help");
    }
}

void GpuEngine::endLaunches() {
    while (!launches_.isEmpty()) endLaunch();
}

// Goes on to the next part of a large film. False: this one was the last.
bool GpuEngine::nextRegion() {
    if (region_->isWhole()) return false;
    finishPaths();
    endLaunches();
    refresh();
    const std::size_t next = region_->first() + region_->slotCount() / settings_.replicates;
    if (next >= tiles_.size()) return false;
    region_->load(film_, tiles_, next);
    pass_->nextSlot = 0;
    return true;
}

void GpuEngine::refresh() {
    region_->store(film_);
    dirty_ = false;
    sinceRefresh_ = {};
}

const Film& GpuEngine::film() {
    if (dirty_ && !failed_) {
        try {
            refresh();
        } catch (const RenderError&) {
            failed_ = true; // the next call returns what there is
            throw;
        }
    }
    return film_;
}

// From the device at once, which leaves the rest of the work to whoever packs them.
app::TilesToPack GpuEngine::takeTiles(const image::TileList& tiles) {
    if (failed_ || !dirty_ || tiles.empty() || !region_->isWhole()) return Engine::takeTiles(tiles);
    try {
        app::TilesToPack taken = region_->take(readBacks_);
        dirty_ = false;
        return taken;
    } catch (const RenderError&) {
        failed_ = true; // the next call returns what there is
        throw;
    }
}

app::Snapshot GpuEngine::snapshot() {
    if (failed_ || !region_ || !region_->isImage()) return Engine::snapshot();
    try {
        if (!resolver_) resolver_.emplace(context_, cache_);
        return region_->snapshot(*resolver_);
    } catch (const RenderError&) {
        failed_ = true; // the next call returns what there is
        throw;
    }
}

// ---- the rest ------------------------------------------------------------------------------------------------------

app::AovImages GpuEngine::renderAovs(const app::AovRequest& request, std::uint32_t samples) {
    if (!firstHits_) {
        firstHits_ = makeKernel(KernelPurpose::FirstHits);
        cache_.save();
    }
    return renderAovPass(context_, *firstHits_, settings_.width, settings_.height, request, samples);
}

image::Image GpuEngine::renderCost(app::Cost cost, std::uint32_t samples) {
    if (!knowsCost(cost)) return {};
    const auto kernel = makeKernel(cost == app::Cost::Time ? KernelPurpose::Time : KernelPurpose::Rays);
    cache_.save();
    return renderCostPass(context_, *kernel, settings_.width, settings_.height, settings_.maxDepth,
                          std::max(samples, 1u));
}

app::Preview GpuEngine::renderPreview(const scene::CameraDesc& camera, std::uint32_t width, std::uint32_t height) {
    if (!canPreview()) return {};
    if (!preview_) {
        preview_.emplace(context_, cache_, *scene_);
        cache_.save();
    }
    return preview_->render(camera, width, height);
}

app::EngineReport GpuEngine::report() const {
    app::EngineReport report = report_;
    report.engine = app::nameOf(app::kGpuEngines, engine_);
    report.device = context_.info().name;
    report.isSoftware = context_.info().isSoftware();
    report.features = features_;
    report.lightSampling = app::describeLightShapes(settings_, features_);
    if (kernel_) {
        report.kernel = kernel_->name();
        for (const vulkan::ShaderFigure& figure : vulkan::shaderFigures(context_, kernel_->pipeline()))
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
