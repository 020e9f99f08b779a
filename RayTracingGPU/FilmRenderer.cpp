#include "RayTracingGPU/FilmRenderer.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "Common/Core/Error.h"
#include "Common/Image/SamplePlan.h"
#include "Common/Render/RenderParams.h"
#include "Common/Vulkan/Check.h"
#include "RayTracingGPU/Kernels.h"

namespace rt::gpu {

using image::Film;

FilmRenderer::FilmRenderer(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache,
                           const GpuEngineOptions& options, app::GpuEngineKind engine, const RenderKernels& kernels,
                           app::EngineReport& report)
    : context_(context),
      cache_(cache),
      options_(options),
      kernels_(kernels),
      report_(report),
      launches_(context, cache, {.invocations = maxInvocations(context, engine), .samples = kMaxSamples}),
      readBacks_(context) {}

void FilmRenderer::adopt(const app::RenderSettings& settings, shared::Features features, bool sharesPaths) {
    if (settings.maxDepth > settings_.maxDepth) launchSize_.reset();
    settings_ = settings;
    features_ = features;
    sharesPaths_ = sharesPaths;
}

void FilmRenderer::setPart(Film film) {
    film_ = std::move(film);
    tiles_.clear();
    region_ = nullptr;
    dirty_ = false;
}

void FilmRenderer::makeReady(bool anew) {
    if (anew || !launchSize_)
        launchSize_.emplace(context_.info().isSoftware(), settings_.maxDepth, options_.launchSeconds);
    const std::uint64_t samples = std::uint64_t{settings_.width} * settings_.height * settings_.spp;
    launches_.prepare(context_.info().isDiscrete() ? samples : 0);
}

void FilmRenderer::setFilm(Film film) {
    film_ = std::move(film);
    tiles_ = image::allTiles(film_);
    limit_.reset();
    loadTiles();
}

void FilmRenderer::renderOnly(image::TileList tiles, std::uint32_t spp, std::span<const std::byte> packed) {
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

void FilmRenderer::loadTiles() {
    const auto count = static_cast<std::uint32_t>(std::max<std::size_t>(tiles_.size(), 1));
    const std::uint32_t tiles = std::min(count, std::max(1u, options_.regionSlots / settings_.replicates));
    if (!region_ || !region_->fits(film_, tiles, sharesPaths_)) {
        region_ = nullptr; // its memory may be needed for the next one
        region_ = std::make_unique<DeviceFilm>(context_, film_.desc(), tiles, sharesPaths_);
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

app::RenderStatus FilmRenderer::renderSome(const app::Budget& budget) {
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
bool FilmRenderer::beginPass(const std::atomic<bool>* cancel) {
    if (begun_ >= goal_ && !limit_ && film_.isPilot()) planSamples(cancel);
    if (tiles_.empty() || begun_ >= goal_) return false;
    if (region_->first() != 0) region_->load(film_, tiles_, 0);
    const std::uint64_t wanted = settings_.sppIsKnown ? launchSize_->samplesIn(options_.passSeconds) : 0;
    pass_ = planPass(*region_, begun_, goal_, launchSize_->suggest(), wanted, kMaxSamples);
    if (pass_->end % (shared::kBlock * settings_.replicates) != 0) region_->reserveOpenBlocks();
    return true;
}

// Decides on the samples of an adaptive film, whose pilot is done, and goes on with them.
void FilmRenderer::planSamples(const std::atomic<bool>* cancel) {
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
void FilmRenderer::launchNext() {
    const shared::FilmLaunch launch = nextLaunch(*region_, *pass_, launchSize_->suggest(), kMaxSamples);
    beginLaunch(launch);
    pass_->nextSlot += launch.bandWidth;
    if (pass_->nextSlot == region_->bandSlots() && !nextRegion()) {
        begun_ = pass_->end;
        pass_.reset();
    }
}

void FilmRenderer::beginLaunch(shared::FilmLaunch launch) {
    if (launches_.overlaps(launch)) finishPaths();
    launch.sampleCount = region_->numbersOf(launch);
    while (!launches_.hasRoom(launch, kernels_.sharePaths())) endLaunch();
    samplesDone_ += launches_.begin(kernels_.ofLaunches(), *region_, launch);
    dirty_ = true;
}

// Goes on with the paths that the last launch has left, and leaves none.
void FilmRenderer::finishPaths() {
    if (!launches_.isUnfinished()) return;
    while (!launches_.hasRoom({}, false)) endLaunch();
    samplesDone_ += launches_.finish(kernels_.ofLaunches(), *region_);
    dirty_ = true;
}

// Waits for the end of the oldest launch that has not ended.
void FilmRenderer::endLaunch() {
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

void FilmRenderer::endLaunches() {
    while (!launches_.isEmpty()) endLaunch();
}

// Goes on to the next part of a large film. False: this one was the last.
bool FilmRenderer::nextRegion() {
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

void FilmRenderer::refresh() {
    region_->store(film_);
    dirty_ = false;
    sinceRefresh_ = {};
}

template <class Function>
auto FilmRenderer::reading(Function read) {
    try {
        return read();
    } catch (const RenderError&) {
        failed_ = true;
        throw;
    }
}

const Film& FilmRenderer::film() {
    if (dirty_ && !failed_) reading([&] { refresh(); });
    return film_;
}

// At once, which leaves the rest of the work to whoever packs them.
std::optional<app::TilesToPack> FilmRenderer::takeTiles(const image::TileList& tiles) {
    if (failed_ || !dirty_ || tiles.empty() || !region_->isWhole()) return std::nullopt;
    return reading([&] {
        app::TilesToPack taken = region_->take(readBacks_);
        dirty_ = false;
        return taken;
    });
}

std::optional<app::Snapshot> FilmRenderer::snapshot() {
    if (failed_ || !region_ || !region_->isImage()) return std::nullopt;
    return reading([&] {
        if (!resolver_) resolver_.emplace(context_, cache_);
        return region_->snapshot(*resolver_);
    });
}

std::uint64_t FilmRenderer::resolveHalves(const vulkan::Buffer& to) {
    if (failed_ || !region_) return 0;
    if (!resolver_) resolver_.emplace(context_, cache_);
    return region_->resolveHalves(*resolver_, to);
}

std::uint64_t FilmRenderer::resolveOne(const vulkan::Buffer& to) {
    if (failed_ || !region_) return 0;
    if (!resolver_) resolver_.emplace(context_, cache_);
    return region_->resolveOne(*resolver_, to);
}

} // namespace rt::gpu
