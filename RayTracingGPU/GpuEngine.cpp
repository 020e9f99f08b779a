#include "RayTracingGPU/GpuEngine.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <span>
#include <utility>

#include "Common/App/RenderParams.h"
#include "Common/Core/Error.h"
#include "Common/Scene/CameraRecord.h"
#include "Common/Shared/Features.h"
#include "Common/Vulkan/Check.h"
#include "Common/Vulkan/PipelineCache.h"
#include "RayTracingGPU/AovPass.h"
#include "RayTracingGPU/ComputePipeline.h"
#include "RayTracingGPU/CostPass.h"
#include "RayTracingGPU/DeviceFilm.h"
#include "RayTracingGPU/EngineChoice.h"
#include "RayTracingGPU/GpuScene.h"
#include "RayTracingGPU/PreviewPass.h"
#include "RayTracingGPU/RtPipeline.h"

namespace rt::gpu {
namespace {

using Clock = std::chrono::steady_clock;
using image::Film;
using vulkan::Memory;

constexpr std::uint32_t kInvocations = 1u << 18;    // that share the work of a launch; fills the largest devices
constexpr std::uint64_t kMaxBlockSums = 10'000'000; // of a launch: 120 MB
constexpr std::uint64_t kLongRounds = 4;            // of blocks, which make a pass long
constexpr std::uint64_t kOpenSamples = 2;           // of the block at the end of a shorter pass
constexpr std::uint64_t kRegionRounds = 8;          // per pass where regions take turns, each turn costing two copies

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr VkDeviceSize kCounterBytes = shared::kCounterLines * shared::kCounters * sizeof(std::uint32_t);

// What is handed to the device at a time.
struct Launch {
    explicit Launch(vulkan::VulkanContext& context)
        : run(context), counters(context, kCounterBytes, 0, Memory::ReadBack, "counters") {}

    vulkan::Run run;
    vulkan::Buffer counters; // of it, when it has ended
    DeviceFilm::Work work;   // that it does
};

// What a kernel is compiled for.
struct KernelKey {
    PipelineDecisions decisions;
    TraversalShape shape; // of the compute engine
    bool operator==(const KernelKey&) const = default;
};

class GpuEngine final : public app::Engine {
  public:
    GpuEngine(vulkan::VulkanContext& context, const GpuEngineOptions& options)
        : context_(context),
          options_(options),
          cache_(context, options.pipelineCache ? vulkan::pipelineCacheFile(context) : ""),
          engine_(chooseEngine(options.engine, context.info())),
          bindings_(context, engine_, std::max(sizeof(shared::FilmLaunch), sizeof(shared::PixelLaunch))),
          reducer_(context, cache_),
          constants_(context, sizeof(shared::RenderConstants), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, Memory::Device,
                     "constants"),
          counters_(context, kCounterBytes, 0, Memory::Device, "counters"),
          launches_{Launch(context), Launch(context)} {}

    bool setScene(std::shared_ptr<const scene::CompiledScene> compiled, const std::atomic<bool>* cancel) override {
        auto prepared = std::make_unique<GpuScene>(context_, engine_, std::move(compiled), cancel);
        if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) return false;
        preview_.reset();
        scene_ = std::move(prepared);
        launchSize_.reset();
        return true;
    }

    void reset(const scene::CameraDesc& camera, const app::RenderSettings& settings) override;
    void restore(Film film) override { setFilm(std::move(film)); }
    app::RenderStatus renderSome(const app::Budget& budget) override;
    const Film& film() override;
    app::Snapshot snapshot() override;
    app::AovImages renderAovs(const app::AovRequest& request, std::uint32_t samples) override;
    bool knowsCost(app::Cost cost) const override { return cost == app::Cost::Rays || context_.info().hasShaderClock; }
    image::Image renderCost(app::Cost cost, std::uint32_t samples) override;
    bool canPreview() const override { return context_.info().draws; }
    app::Preview renderPreview(const scene::CameraDesc& camera, std::uint32_t width, std::uint32_t height) override;
    app::EngineReport report() const override;

  private:
    bool isCompute() const { return engine_ == app::GpuEngineKind::Compute; }
    std::unique_ptr<Kernel> makeKernel(const KernelKey& key, Shader compute, Shader rayGeneration) const;
    std::uint32_t maxInvocations() const;
    void setFilm(Film film);
    void uploadConstants(const scene::CameraDesc& camera);
    bool beginPass();
    void launchNext();
    void beginLaunch(const shared::FilmLaunch& launch);
    void endLaunch();
    void endLaunches();
    void dropLaunches();
    double secondsAhead() const;
    bool nextRegion();
    void refresh();

    std::uint64_t pixels() const { return std::uint64_t{settings_.width} * settings_.height; }

    vulkan::VulkanContext& context_;
    GpuEngineOptions options_;
    vulkan::PipelineCache cache_;
    app::GpuEngineKind engine_; // which was chosen
    RenderBindings bindings_;
    FilmReducer reducer_;
    std::optional<FilmResolver> resolver_; // once it was needed
    vulkan::Buffer constants_;
    vulkan::Buffer counters_;
    vulkan::Buffer blockSums_;

    std::unique_ptr<GpuScene> scene_;
    std::optional<PreviewPass> preview_; // of the scene, once it was asked for
    app::RenderSettings settings_;
    shared::RenderParams params_{};
    std::uint32_t features_ = 0;
    std::unique_ptr<Kernel> kernel_;
    KernelKey kernelKey_;

    Film film_;                          // the whole film, on the host
    std::unique_ptr<DeviceFilm> region_; // the part that is being rendered: all of it unless it is large
    bool dirty_ = false;                 // region_ is ahead of film_
    bool failed_ = false;                // the device did: nothing may be read from it any more
    Clock::time_point refreshed_;
    std::uint64_t samplesDone_ = 0;
    bool inPass_ = false;
    std::uint32_t passEnd_ = 0;    // samples per pixel that the pass in progress leads to
    std::uint32_t passRounds_ = 0; // blocks of each slot that it takes, the first and last perhaps in part
    double passSamples_ = 0;       // of each slot's pixels
    bool passIsLong_ = false;
    std::uint32_t nextSlot_ = 0;           // of each of the region's bands: the first that the pass has not launched
    std::optional<LaunchSize> launchSize_; // of this scene and pipeline
    // The next launch is recorded while the device works at one, or it would have nothing to do in between.
    std::array<Launch, 2> launches_;
    std::uint64_t begun_ = 0; // launches, of which number n is launches_[n % 2]
    std::uint64_t ended_ = 0;
    app::EngineReport report_;
};

// ---- set-up ----------------------------------------------------------------------------------------------------------

void GpuEngine::reset(const scene::CameraDesc& camera, const app::RenderSettings& settings) {
    features_ = app::renderFeatures(scene_->compiled(), camera, settings);
    if (shared::has(features_, shared::kFeatureMovingSpheres)) scene_->provideMotion(context_);
    if (settings.maxDepth > settings_.maxDepth) launchSize_.reset();
    settings_ = settings;
    params_ = app::makeRenderParams(scene_->compiled(), settings);
    setFilm(Film({settings.width, settings.height, settings.replicates, settings.secondMoments}));
    uploadConstants(camera);
    if (isCompute()) {
        bindings_.update(constants_, scene_->flatLists());
    } else {
        bindings_.update(constants_, scene_->topLevel());
    }

    const KernelKey key{makeDecisions(features_, params_), scene_->shape()};
    if (!kernel_ || kernelKey_ != key) {
        const Clock::time_point start = Clock::now();
        kernel_ = nullptr;
        const bool projected = shared::has(features_, shared::kFeatureProjected);
        kernel_ =
            makeKernel(key, projected ? Shader::ProjectedPathCompute : Shader::PathCompute, Shader::RayGeneration);
        kernelKey_ = key;
        cache_.save();
        report_.pipelineSeconds = secondsSince(start);
        launchSize_.reset();
    }
    if (!launchSize_) launchSize_.emplace(context_.info().isSoftware(), settings.maxDepth);
    report_.rays = {};
    report_.nonfiniteSamples = 0;
    report_.renderDeviceSeconds = 0;
}

std::unique_ptr<Kernel> GpuEngine::makeKernel(const KernelKey& key, Shader compute, Shader rayGeneration) const {
    if (isCompute()) {
        return std::make_unique<ComputePipeline>(context_, cache_, bindings_, key.decisions, key.shape, compute);
    }
    return std::make_unique<RtPipeline>(context_, cache_, bindings_, key.decisions, rayGeneration);
}

void GpuEngine::uploadConstants(const scene::CameraDesc& camera) {
    const scene::CompiledScene& s = scene_->compiled();
    shared::RenderConstants constants;
    constants.arrays = scene_->arrays();
    constants.tree = scene_->tree();
    constants.globals = s.globals;
    constants.params = params_;
    constants.camera = scene::makeCamera(camera, settings_.width, settings_.height, s.origin);
    vulkan::upload(context_, constants_, std::as_bytes(std::span(&constants, 1)));
}

void GpuEngine::setFilm(Film film) {
    film_ = std::move(film);
    const std::uint32_t tiles = std::min(film_.tileCount(), std::max(1u, options_.regionSlots / settings_.replicates));
    if (!region_ || !region_->fits(film_.desc(), tiles)) {
        region_ = nullptr; // its memory may be needed for the next one
        region_ = std::make_unique<DeviceFilm>(context_, film_.desc(), tiles);
    }
    region_->load(film_, 0);
    samplesDone_ = film_.totalSamples();
    dirty_ = false;
    failed_ = false;
    inPass_ = false;
    refreshed_ = Clock::now();
}

// ---- rendering -------------------------------------------------------------------------------------------------------

app::RenderStatus GpuEngine::renderSome(const app::Budget& budget) {
    if (!region_) throw RenderError("there was no memory for the film");
    const Clock::time_point start = Clock::now();
    const double seconds = budget.time.count();
    try {
        while (budget.cancel == nullptr || !budget.cancel->load(std::memory_order_relaxed)) {
            if (!inPass_ && !beginPass()) break;
            launchNext();
            if (secondsSince(start) + secondsAhead() >= seconds) break;
        }
        endLaunches();
        if (dirty_ && secondsSince(refreshed_) > kRefreshSeconds) refresh();
    } catch (const vulkan::DeviceLostError&) {
        failed_ = true;
        dropLaunches();
        throw;
    } catch (...) {
        dropLaunches();
        throw;
    }
    app::RenderStatus status;
    status.samplesTotal = pixels() * settings_.spp;
    status.samplesDone = samplesDone_;
    status.finished = samplesDone_ >= status.samplesTotal;
    return status;
}

// Opens the next pass, which takes every pixel as many samples further as fit in a launch, but at least one of each replicate. Many
// are rounded to whole blocks. Few may end within a block: an invocation takes its samples one after the other, and 16 long paths in
// a medium may last longer than a launch should. More than a block end soon after the beginning of the last one, whose items
// a launch then has left at its end. Large films go on by whole blocks.
bool GpuEngine::beginPass() {
    if (samplesDone_ >= pixels() * settings_.spp) return false;
    if (region_->firstTile() != 0) region_->load(film_, 0);
    const std::uint64_t round = std::uint64_t{shared::kBlock} * settings_.replicates; // samples per pixel
    const std::uint64_t least = region_->isWhole() ? region_->leastSamples() : film_.minSamples();
    std::uint64_t end = (least / round + kRegionRounds) * round;
    bool isLong = true;
    if (region_->isWhole()) {
        const std::uint64_t room = kMaxBlockSums / (std::uint64_t{region_->slotCount()} * shared::kTilePixels) * round;
        const std::uint64_t fitting = std::min(launchSize_->suggest(options_.launchSeconds) / pixels(), room);
        isLong = fitting >= kLongRounds * round;
        end = least + std::max<std::uint64_t>(settings_.replicates, fitting);
        const std::uint64_t open = isLong ? 0 : kOpenSamples * settings_.replicates;
        const std::uint64_t rounded = end < open ? 0 : (end - open) / round * round + open;
        if (rounded >= least + round) end = rounded;
    }
    end = std::min<std::uint64_t>(end, settings_.spp);
    passEnd_ = static_cast<std::uint32_t>(end);
    passRounds_ = static_cast<std::uint32_t>((end + round - 1) / round - least / round);
    passSamples_ = static_cast<double>(end - least) / settings_.replicates;
    passIsLong_ = isLong;
    if (end % round != 0) region_->reserveOpenBlocks();
    nextSlot_ = 0;
    inPass_ = true;
    return true;
}

// Launches the next slots of the pass in all bands; behind the last ones of the last region the pass is over.
void GpuEngine::launchNext() {
    const std::uint64_t pixels = std::uint64_t{region_->bands()} * shared::kTilePixels; // of one slot in each band
    const auto fitting = static_cast<std::uint64_t>(static_cast<double>(launchSize_->suggest(options_.launchSeconds)) /
                                                    (static_cast<double>(pixels) * passSamples_));
    const std::uint64_t room = std::max<std::uint64_t>(kMaxBlockSums / (passRounds_ * pixels), 1);
    const std::uint64_t most = std::min<std::uint64_t>(region_->bandSlots() - nextSlot_, room);
    const auto width = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(fitting, 1, most));
    shared::FilmLaunch push{};
    region_->describe(push, nextSlot_, width);
    push.blocks = passRounds_;
    push.spp = passEnd_;
    push.byBlock = passIsLong_ ? 0u : 1u;
    beginLaunch(push);
    nextSlot_ += width;
    if (nextSlot_ == region_->bandSlots()) inPass_ = nextRegion();
}

std::uint32_t GpuEngine::maxInvocations() const {
    return isCompute() ? kInvocations : std::min(kInvocations, context_.limits().maxInvocations);
}

// Hands a launch to the device, while that works at no more than one other.
void GpuEngine::beginLaunch(const shared::FilmLaunch& filmLaunch) {
    if (begun_ - ended_ == launches_.size()) endLaunch();
    shared::FilmLaunch push = filmLaunch;
    const std::uint32_t items = push.slotCount * push.blocks * shared::kTilePixels;
    const VkDeviceSize bytes = VkDeviceSize{items} * sizeof(shared::vec3);
    if (blockSums_.bytes() < bytes) {
        endLaunches();
        blockSums_ = {};
        blockSums_ = vulkan::Buffer(context_, bytes, 0, Memory::Device, "a launch");
    }
    push.blockSums = blockSums_.address();
    push.counters = counters_.address();
    Launch& next = launches_[begun_ % launches_.size()];
    next.run.begin([&](VkCommandBuffer commands) {
        vkCmdFillBuffer(commands, counters_.get(), 0, VK_WHOLE_SIZE, 0);
        vulkan::barrier(commands);
        kernel_->launch(commands, push, std::min(items, maxInvocations()));
        vulkan::barrier(commands);
        reducer_.reduce(commands, push);
        const VkBufferCopy all{0, 0, kCounterBytes};
        vkCmdCopyBuffer(commands, counters_.get(), next.counters.get(), 1, &all);
        vulkan::barrier(commands);
    });
    ++begun_;
    next.work = region_->advance(push);
    samplesDone_ += next.work.samples;
    dirty_ = true;
}

// Waits for the end of the oldest launch that has not ended.
void GpuEngine::endLaunch() {
    Launch& launch = launches_[ended_++ % launches_.size()];
    const double seconds = context_.finishTimed(launch.run);
    launchSize_->measured(launch.work.samples, seconds);

    report_.renderDeviceSeconds += seconds;
    report_.rays.camera += launch.work.samples;
    std::uint64_t finished = 0;
    const std::span<const std::uint32_t> counters = launch.counters.mapped<const std::uint32_t>();
    for (std::size_t line = 0; line < counters.size(); line += shared::kCounters) {
        report_.rays.scattered += counters[line + shared::kCounterScattered];
        report_.rays.shadow += counters[line + shared::kCounterShadow];
        report_.nonfiniteSamples += counters[line + shared::kCounterNonfinite];
        finished += counters[line + shared::kCounterItems];
    }
    // Drivers have been seen that end long loops early.
    if (finished != launch.work.items) {
        failed_ = true; // what is on the device is not a film
        throw RenderError(context_.info().name + " ended a shader before its work was done (" +
                          std::to_string(finished) + " of " + std::to_string(launch.work.items) +
                          " items); a newer driver may help");
    }
}

void GpuEngine::endLaunches() {
    while (ended_ < begun_) endLaunch();
}

// How long the device is going to be at what it has been handed.
double GpuEngine::secondsAhead() const {
    std::uint64_t samples = 0;
    for (std::uint64_t i = ended_; i < begun_; ++i) samples += launches_[i % launches_.size()].work.samples;
    return launchSize_->secondsFor(samples);
}

// After a failure: nothing that the device still works at may be touched.
void GpuEngine::dropLaunches() {
    for (; ended_ < begun_; ++ended_) {
        try {
            launches_[ended_ % launches_.size()].run.finish();
        } catch (const RenderError&) { // as the one before
        }
    }
}

// Goes on to the next part of a large film. False: this one was the last.
bool GpuEngine::nextRegion() {
    if (region_->isWhole()) return false;
    endLaunches();
    refresh();
    const std::uint32_t next = region_->firstTile() + region_->slotCount() / settings_.replicates;
    if (next >= film_.tileCount()) return false;
    region_->load(film_, next);
    nextSlot_ = 0;
    return true;
}

void GpuEngine::refresh() {
    region_->store(film_);
    dirty_ = false;
    refreshed_ = Clock::now();
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

app::Snapshot GpuEngine::snapshot() {
    if (failed_ || !region_ || !region_->isWhole()) return Engine::snapshot();
    try {
        if (!resolver_) resolver_.emplace(context_, cache_);
        return region_->snapshot(*resolver_);
    } catch (const RenderError&) {
        failed_ = true; // the next call returns what there is
        throw;
    }
}

// ---- the rest --------------------------------------------------------------------------------------------------------

app::AovImages GpuEngine::renderAovs(const app::AovRequest& request, std::uint32_t samples) {
    const std::unique_ptr<Kernel> kernel = makeKernel(kernelKey_, Shader::AovCompute, Shader::AovGeneration);
    cache_.save();
    return renderAovPass(context_, *kernel, settings_.width, settings_.height, request, samples);
}

image::Image GpuEngine::renderCost(app::Cost cost, std::uint32_t samples) {
    if (!knowsCost(cost)) return {};
    constexpr Shader kCompute[2][2] = {{Shader::CostCompute, Shader::ProjectedCostCompute},
                                       {Shader::TimeCompute, Shader::ProjectedTimeCompute}};
    constexpr Shader kGeneration[2] = {Shader::CostGeneration, Shader::TimeGeneration};
    const int time = cost == app::Cost::Time ? 1 : 0;
    const int projected = shared::has(features_, shared::kFeatureProjected) ? 1 : 0;
    const auto kernel = makeKernel(kernelKey_, kCompute[time][projected], kGeneration[time]);
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
    report.features = features_;
    report.lightSampling = app::describeLightShapes(settings_, features_);
    if (kernel_) report.kernel = kernel_->name();
    if (scene_) report.accelBuildSeconds = scene_->buildSeconds();
    report.deviceBytes = context_.deviceBytes();
    report.longestDispatchSeconds = context_.longestRun();
    return report;
}

} // namespace

std::unique_ptr<app::Engine> makeGpuEngine(vulkan::VulkanContext& context, const GpuEngineOptions& options) {
    return std::make_unique<GpuEngine>(context, options);
}

} // namespace rt::gpu
