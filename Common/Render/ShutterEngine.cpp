#include "Common/Render/ShutterEngine.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "Common/Core/Hash.h"
#include "Common/Core/Interruption.h"
#include "Common/Render/PictureDenoiser.h"
#include "Common/Render/RenderParams.h"
#include "Common/Render/Stopwatch.h"
#include "Common/Scene/FollowedCamera.h"
#include "Common/Shared/Base/Random.h"

namespace rt::app {
namespace {

using image::Film;

// Keep what is random of poses apart from each other and from all that an engine makes of the same seed.
constexpr std::uint32_t kTimeKey = 0x70053u, kSeedKey = 0x5eed5u, kAovKey = 0xa0705u;

bool isCancelled(const std::atomic<bool>* cancel) {
    return cancel != nullptr && cancel->load(std::memory_order_relaxed);
}

// Samples of a replicate among the first `total` of a pixel.
std::uint32_t samplesOfReplicate(std::uint64_t total, std::uint32_t replicate, std::uint32_t replicates) {
    return static_cast<std::uint32_t>((total + replicates - 1 - replicate) / replicates);
}

void addCounts(const EngineReport& more, EngineReport& sum) {
    sum.rays += more.rays;
    sum.nonfiniteSamples += more.nonfiniteSamples;
    sum.cutOff += more.cutOff;
    sum.renderDeviceSeconds += more.renderDeviceSeconds;
}

// Sums of features over poses. A depth is of those poses only in which the pixel has one.
class FeatureSums {
  public:
    void add(AovImages images) {
        if (count_++ == 0) {
            sum_ = std::move(images);
            countDepths(sum_.depth, depths_);
            countDepths(sum_.wide.depth, wideDepths_);
            return;
        }
        addSurface(images, sum_, depths_);
        addSurface(images.wide, sum_.wide, wideDepths_);
        addTo(images.emission, sum_.emission);
    }
    AovImages mean() && {
        for (image::Image* image : {&sum_.albedo, &sum_.normal, &sum_.wide.albedo, &sum_.wide.normal, &sum_.emission})
            for (float& value : image->data) value /= static_cast<float>(count_);
        divide(sum_.depth, depths_);
        divide(sum_.wide.depth, wideDepths_);
        return std::move(sum_);
    }

  private:
    static void addTo(const image::Image& more, image::Image& sum) {
        for (std::size_t i = 0; i < sum.data.size(); ++i) sum.data[i] += more.data[i];
    }
    static void countDepths(const image::Image& depth, std::vector<std::uint32_t>& counts) {
        counts.resize(depth.data.size());
        for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += depth.data[i] > 0 ? 1 : 0;
    }
    static void addSurface(const SurfaceImages& more, SurfaceImages& sum, std::vector<std::uint32_t>& depths) {
        addTo(more.albedo, sum.albedo);
        addTo(more.normal, sum.normal);
        addTo(more.depth, sum.depth);
        countDepths(more.depth, depths);
    }
    static void divide(image::Image& sum, const std::vector<std::uint32_t>& counts) {
        for (std::size_t i = 0; i < counts.size(); ++i) sum.data[i] /= static_cast<float>(std::max(counts[i], 1u));
    }

    AovImages sum_;
    std::vector<std::uint32_t> depths_, wideDepths_; // poses that have one
    std::uint32_t count_ = 0;
};

// Snapshots, packed tiles and live denoisers are those that any engine has, of the film here: that of `engine_` is of
// one replicate, and what it sees is one pose.
class ShutterEngine final : public Engine {
  public:
    ShutterEngine(Engine& engine, double open, double close, PoseScene pose)
        : engine_(&engine), open_(open), close_(close), pose_(std::move(pose)) {}
    void own(std::unique_ptr<Engine> engine) { owned_ = std::move(engine); }

    // Only what it is like: what is rendered are poses.
    bool setScene(std::shared_ptr<const scene::CompiledScene> scene, const std::atomic<bool>* cancel) override {
        leavePose();
        if (!engine_->setScene(scene, cancel)) return false;
        scene_ = std::move(scene);
        const EngineReport report = engine_->report();
        rates_ = report.rates;
        ratesAreOfBefore_ = report.ratesAreOfBefore;
        return true;
    }

    void reset(const scene::CameraDesc& camera, const RenderSettings& settings) override {
        leavePose();
        camera_ = camera;
        settings_ = settings;
        film_ = Film(filmDesc(settings));
        tiles_ = image::allTiles(film_);
        limit_ = settings.spp;
        countSamples();
        counts_ = {};
        engine_->reset(camera, settingsOf(0));
        features_ = engine_->report().features;
    }
    void restore(Film film) override {
        leavePose();
        film_ = std::move(film);
        countSamples();
    }
    void renderOnly(image::TileList tiles, std::uint32_t spp, std::span<const std::byte> packed) override {
        leavePose();
        image::unpackTiles(packed, film_);
        tiles_ = std::move(tiles);
        limit_ = spp;
        countSamples();
    }

    RenderStatus renderSome(const Budget& budget) override;

    const Film& film() override {
        collect();
        return film_;
    }
    AovImages renderAovs(const AovRequest& request, std::uint32_t samples) override;
    bool knowsCost(Cost cost) const override { return engine_->knowsCost(cost); }
    image::Image renderCost(Cost cost, std::uint32_t samples) override { return engine_->renderCost(cost, samples); }
    bool canPreview() const override { return engine_->canPreview(); }
    Preview renderPreview(const scene::CameraDesc& camera, std::uint32_t width, std::uint32_t height) override {
        return engine_->renderPreview(camera, width, height);
    }
    DenoisedPicture denoiseHalves(const image::DenoiseInput& halves, bool details, std::uint32_t threads) override {
        return engine_->denoiseHalves(halves, details, threads);
    }
    EngineReport report() const override;
    std::uint64_t motionHash() override;

  private:
    struct Task {
        std::uint32_t replicate = 0;
        PoseOfSample pose;
    };

    RenderSettings settingsOf(std::uint32_t replicate) const;
    std::optional<Task> nextTask() const;
    bool begin(const Task& task, const std::atomic<bool>* cancel);
    std::shared_ptr<const scene::CompiledScene> poseAt(double share, const std::atomic<bool>* cancel) const;
    bool setPose(double share, const std::atomic<bool>* cancel);
    Film replicateFilm(std::uint32_t replicate) const;
    void collect();
    // What the engine has rendered is on film_, and it may be used for other things.
    void leavePose() {
        collect();
        if (task_) addCounts(engine_->report(), counts_);
        task_.reset();
    }
    void countSamples() {
        status_.samplesDone = image::totalSamples(film_, tiles_);
        status_.samplesTotal = status_.samplesDone + image::missingSamples(film_, tiles_, limit_);
    }

    std::unique_ptr<Engine> owned_; // null: it is somebody else's
    Engine* const engine_;
    const double open_, close_; // seconds
    const PoseScene pose_;
    std::shared_ptr<const scene::CompiledScene> scene_; // what camera_ is of
    scene::CameraDesc camera_;
    RenderSettings settings_;
    Film film_; // of all replicates; behind the engine's by what that has rendered since collect()
    image::TileList tiles_;
    std::uint32_t limit_ = 0;
    std::optional<Task> task_;     // in progress: the engine has its pose, and a film of its replicate
    bool isBehind_ = false;        // film_
    RenderStatus status_;          // of all replicates
    std::uint64_t doneInTask_ = 0; // samples of the replicate's film
    std::shared_ptr<const scene::CompiledScene> posed_;

    EngineReport counts_; // of tasks before the one in progress
    shared::Features features_;
    std::vector<EngineRate> rates_; // by which an engine was chosen for the scene
    bool ratesAreOfBefore_ = false;
    std::optional<std::uint64_t> motionHash_; // once it was asked for
    std::uint32_t poses_ = 0;
    double poseSeconds_ = 0;
};

// A replicate is a render with a seed of its own.
RenderSettings ShutterEngine::settingsOf(std::uint32_t replicate) const {
    RenderSettings settings = settings_;
    settings.replicates = 1;
    settings.spp = samplesOfReplicate(settings_.spp, 0, settings_.replicates);
    if (settings_.replicates > 1) settings.seed = shared::hash3({settings_.seed, replicate, kSeedKey}).x;
    return settings;
}

// That of the least samples first, so that replicates have equally many, but for those of a pose.
std::optional<ShutterEngine::Task> ShutterEngine::nextTask() const {
    std::optional<Task> next;
    std::uint32_t least = 0;
    for (std::uint32_t r = 0; r < settings_.replicates; ++r) {
        std::uint32_t samples = samplesOfReplicate(limit_, r, settings_.replicates);
        const std::uint32_t goal = samples;
        for (const std::uint32_t tile : tiles_) samples = std::min(samples, film_.samples(tile, r));
        if (samples == goal || (next && samples >= least)) continue;
        least = samples;
        next = Task{r, poseOfSample(samples)};
        next->pose.end = std::min(next->pose.end, goal);
    }
    return next;
}

// Null: cancelled.
std::shared_ptr<const scene::CompiledScene> ShutterEngine::poseAt(double share, const std::atomic<bool>* cancel) const {
    try {
        const Interruptible interruptible(cancel);
        return pose_(open_ + share * (close_ - open_));
    } catch (const Interrupted&) {
        return nullptr;
    }
}

// Of both ends, so that animations are told apart that pass through the same pose.
std::uint64_t ShutterEngine::motionHash() {
    if (motionHash_) return *motionHash_;
    const Interruptible whole(nullptr); // what was interrupted is kept by it
    std::uint64_t hash = kHashStart;
    for (const double seconds : {open_, close_}) {
        const auto scene = pose_(seconds);
        hash = hashBytes(std::as_bytes(std::span(&scene->hash, 1)), hash);
    }
    motionHash_ = hash;
    return hash;
}

// False: cancelled, and nothing is in progress.
bool ShutterEngine::setPose(double share, const std::atomic<bool>* cancel) {
    const Stopwatch watch;
    auto scene = poseAt(share, cancel);
    if (!scene) return false;
    posed_ = std::move(scene);
    const bool isSet = engine_->setScene(posed_, cancel);
    poseSeconds_ += watch.seconds();
    return isSet;
}

bool ShutterEngine::begin(const Task& task, const std::atomic<bool>* cancel) {
    if (!setPose(timeOfPose(settings_.seed, task.replicate, task.pose), cancel)) return false;
    engine_->reset(scene::followedCamera(camera_, *scene_, *posed_), settingsOf(task.replicate));
    Film film = replicateFilm(task.replicate);
    doneInTask_ = image::totalSamples(film, tiles_);
    if (doneInTask_ > 0) engine_->restore(std::move(film));
    engine_->renderOnly(tiles_, task.pose.end, {});
    features_ |= engine_->report().features;
    ++poses_;
    task_ = task;
    return true;
}

Film ShutterEngine::replicateFilm(std::uint32_t replicate) const {
    Film film({settings_.width, settings_.height, 1, film_.desc().secondMoments});
    for (const std::uint32_t tile : tiles_) {
        const Film::TileState state = film_.state(tile, replicate);
        if (!state.open.empty()) film.reserveOpenBlocks();
        film.assign(tile, 0, state);
    }
    return film;
}

void ShutterEngine::collect() {
    if (!isBehind_) return;
    const Film& rendered = engine_->film(); // may throw, once
    isBehind_ = false;
    for (const std::uint32_t tile : tiles_) {
        const Film::TileState state = rendered.state(tile, 0);
        if (!state.open.empty()) film_.reserveOpenBlocks();
        film_.assign(tile, task_->replicate, state);
    }
}

RenderStatus ShutterEngine::renderSome(const Budget& budget) {
    const Stopwatch watch;
    do {
        if (!task_) {
            const std::optional<Task> task = nextTask();
            if (!task || !begin(*task, budget.cancel)) break;
        }
        const auto left = std::max(budget.time - std::chrono::duration<double>(watch.seconds()),
                                   std::chrono::duration<double>::zero());
        isBehind_ = true;
        const RenderStatus ofTask = engine_->renderSome({left, budget.cancel, budget.isWatched});
        status_.samplesDone += ofTask.samplesDone - std::exchange(doneInTask_, ofTask.samplesDone);
        if (ofTask.finished) leavePose();
    } while (!isCancelled(budget.cancel) && watch.seconds() < budget.time.count());
    status_.finished = status_.samplesDone >= status_.samplesTotal;
    return status_;
}

AovImages ShutterEngine::renderAovs(const AovRequest& request, std::uint32_t samples) {
    leavePose();
    const std::uint32_t poses = std::clamp(2 * samples, 1u, kAovPoses);
    FeatureSums sums;
    for (std::uint32_t p = 0; p < poses; ++p) {
        const shared::uvec3 random = shared::hash3({settings_.seed, p, kAovKey});
        const double jitter = shared::toUniform(random.x);
        setPose((p + jitter) / poses, nullptr);
        RenderSettings settings = settingsOf(0);
        settings.seed = random.y; // as each pose has few samples of a pixel, at other places of it
        engine_->reset(scene::followedCamera(camera_, *scene_, *posed_), settings);
        sums.add(engine_->renderAovs(request, std::max(samples / poses, 1u)));
    }
    return std::move(sums).mean();
}

EngineReport ShutterEngine::report() const {
    EngineReport report = engine_->report();
    EngineReport counts = counts_;
    if (task_) addCounts(report, counts);
    report.rays = counts.rays;
    report.nonfiniteSamples = counts.nonfiniteSamples;
    report.cutOff = counts.cutOff;
    report.renderDeviceSeconds = counts.renderDeviceSeconds;
    report.features |= features_;
    report.rates = rates_;
    report.ratesAreOfBefore = ratesAreOfBefore_;
    report.deviceBytes += film_.bytes();
    report.shutter = ShutterFigures{open_, close_, poses_, poseSeconds_};
    return report;
}

} // namespace

PoseOfSample poseOfSample(std::uint32_t sample) {
    const auto octave = static_cast<std::uint32_t>(std::bit_width(sample / kPosesOfOneSample));
    const std::uint32_t level = (octave + 1) / 2, pose = sample >> level;
    return {level, pose, (pose + 1) << level};
}

double timeOfPose(std::uint32_t seed, std::uint32_t replicate, const PoseOfSample& pose) {
    const std::uint32_t key = shared::hash3({seed, replicate, kTimeKey + pose.level}).x;
    return shared::sobolSample(key, pose.pose, shared::kDimensionTime).x * 0x1p-32;
}

std::unique_ptr<Engine> makeShutterEngine(Engine& engine, double open, double close, PoseScene pose) {
    return std::make_unique<ShutterEngine>(engine, open, close, std::move(pose));
}

std::unique_ptr<Engine> makeShutterEngine(std::unique_ptr<Engine> engine, double open, double close, PoseScene pose) {
    auto shutter = std::make_unique<ShutterEngine>(*engine, open, close, std::move(pose));
    shutter->own(std::move(engine));
    return shutter;
}

} // namespace rt::app
