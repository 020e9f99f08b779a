#include "RayTracingCPU/CpuEngine.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "Common/Accel/CpuAccel.h"
#include "Common/Accel/LargeArray.h"
#include "Common/Core/KernelSets.h"
#include "Common/Image/SamplePlan.h"
#include "Common/Render/RenderParams.h"
#include "Common/Scene/CameraRecord.h"
#include "RayTracingCPU/KernelArgs.h"
#include "RayTracingCPU/TileBatch.h"
#include "RayTracingCPU/Workers.h"

namespace rt::cpu {
namespace {

using Clock = std::chrono::steady_clock;
using image::Film;

// Of what is wanted; null elsewhere.
float* planeRow(image::Image& image, std::uint32_t y) {
    return image.data.empty() ? nullptr : image.pixel(0, y);
}

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

std::span<const Kernel> kernelTable(InstructionSet set) {
#define RT_CASE(set, suffix)  \
    case InstructionSet::set: \
        return {kernels_##suffix(), kKernelCount};
    switch (set) {
        RT_KERNEL_SETS(RT_CASE)
        default:
            failWithoutKernels(set);
    }
#undef RT_CASE
}

int count(shared::Features features) {
    return std::popcount(features.scene) + std::popcount(features.materials) + std::popcount(features.methods);
}

// The leanest kernel that covers the features. The last one of a table covers all.
const Kernel& chooseKernel(std::span<const Kernel> kernels, shared::Features features) {
    const Kernel* best = &kernels.back();
    for (const Kernel& kernel : kernels) {
        const bool covers = (features & ~kernel.features) == shared::kFeatureNone;
        if (covers && count(kernel.features) < count(best->features)) best = &kernel;
    }
    return *best;
}

std::array<float, 256> makeSrgbTable() {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double encoded = static_cast<double>(i) / 255.0;
        table[i] = static_cast<float>(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
    }
    return table;
}

// A scene with everything that tracing it on the CPU needs.
struct PreparedScene {
    std::shared_ptr<const scene::CompiledScene> compiled;
    std::unique_ptr<accel::CpuAccel> accel;
    // Descents through a large tree of lights jump about in it, and so does what they end at.
    accel::LargeArray<shared::LightNode> lightNodes;
    accel::LargeArray<shared::Light> lights; // if there are many
    std::array<float, 256> srgbToLinear = makeSrgbTable();
    CpuScene view;
};

CpuScene makeView(const PreparedScene& prepared, InstructionSet set) {
    const scene::CompiledScene& s = *prepared.compiled;
    CpuScene view{shared::viewOf(s, s.globals), prepared.accel->view(), {}};
    view.tracer = accel::rayQuery(set)->tracer(view.accel.kinds);
    if (prepared.lights.size() > 0) view.lights = prepared.lights.data();
    view.lightNodes = prepared.lightNodes.data();
    view.srgbToLinear = prepared.srgbToLinear.data();
    return view;
}

class CpuEngine final : public app::Engine {
  public:
    explicit CpuEngine(const CpuEngineOptions& options)
        : policy_(options.policy), set_(options.instructionSet), kernels_(kernelTable(options.instructionSet)) {
        const std::uint32_t all = std::max(1u, std::thread::hardware_concurrency());
        threads_ = policy_ == Policy::Seq ? 1u : options.threads == 0 ? all : options.threads;
    }

    bool setScene(std::shared_ptr<const scene::CompiledScene> compiled, const std::atomic<bool>* cancel) override {
        const Clock::time_point start = Clock::now();
        auto prepared = std::make_unique<PreparedScene>();
        const scene::CompiledScene& s = *compiled;
        if (!s.lightNodes.empty()) {
            prepared->lightNodes = accel::LargeArray<shared::LightNode>(s.lightNodes);
            prepared->lights = accel::LargeArray<shared::Light>(s.lights);
        }
        const accel::AccelInput input = accel::inputOf(s);
        if (scene_ && scene_->accel->follow(accel::inputOf(*scene_->compiled), input, threads_)) {
            prepared->accel = std::move(scene_->accel);
        } else {
            accel::BuildSettings build;
            build.tree.threads = threads_;
            prepared->accel = accel::CpuAccel::build(input, build, cancel);
            if (!prepared->accel) return false;
        }
        prepared->compiled = std::move(compiled);
        prepared->view = makeView(*prepared, set_);
        scene_ = std::move(prepared);
        report_.accelBuildSeconds = secondsSince(start);
        return true;
    }

    void reset(const scene::CameraDesc& camera, const app::RenderSettings& settings) override {
        begin(camera, settings, Film(app::filmDesc(settings)));
        tiles_ = image::allTiles(film_);
    }

    void resetForLeases(const scene::CameraDesc& camera, const app::RenderSettings& settings) override {
        begin(camera, settings, Film::part(app::filmDesc(settings)));
        tiles_.clear();
    }

    void restore(image::Film film) override {
        film_ = std::move(film);
        nextTile_ = kNoTile;
    }

    void renderOnly(image::TileList tiles, std::uint32_t spp, std::span<const std::byte> packed) override {
        if (film_.isPart()) film_.hold(tiles);
        image::unpackTiles(packed, film_);
        tiles_ = std::move(tiles);
        limit_ = spp;
        nextTile_ = kNoTile;
    }

    app::RenderStatus renderSome(const app::Budget& budget) override {
        const Clock::time_point start = Clock::now();
        const Clock::time_point deadline = start + std::chrono::duration_cast<Clock::duration>(budget.time);
        while (!cancelled(budget)) {
            if (nextTile_ >= tiles_.size() && !beginPass(budget)) break;
            runPass(deadline, budget.cancel);
            if (Clock::now() >= deadline) break;
        }
        report_.renderDeviceSeconds += secondsSince(start);
        return status();
    }

    const image::Film& film() override { return film_; }

    app::AovImages renderAovs(const app::AovRequest& request, std::uint32_t samples) override {
        app::AovImages images = app::makeAovImages(request, settings_.width, settings_.height);
        const std::uint32_t rows = request.rows > 0 ? request.rows : settings_.height;
        const auto planes = [](app::SurfaceImages& of, std::uint32_t y) {
            return SurfacePlanes{planeRow(of.albedo, y), planeRow(of.normal, y), planeRow(of.depth, y)};
        };
        std::atomic<std::uint32_t> nextRow{0};
        runWorkers(policy_, threads_, [&](std::uint32_t) {
            for (std::uint32_t y = nextRow.fetch_add(1, std::memory_order_relaxed); y < rows;
                 y = nextRow.fetch_add(1, std::memory_order_relaxed)) {
                const AovTask task{features_,
                                   request.firstRow + y,
                                   samples,
                                   request.isAdaptive,
                                   planes(images, y),
                                   planes(images.wide, y),
                                   planeRow(images.emission, y)};
                kernel_->renderAovs(context_, task);
            }
        });
        return images;
    }

    bool knowsCost(app::Cost) const override { return true; }
    image::Image renderCost(app::Cost cost, std::uint32_t samples) override {
        const std::uint32_t count = std::clamp(samples, 1u, Film::kBlock);
        image::Image costs(settings_.width, settings_.height, 1);
        std::atomic<std::uint32_t> nextRow{0};
        runWorkers(policy_, threads_, [&](std::uint32_t) {
            for (std::uint32_t y = nextRow.fetch_add(1, std::memory_order_relaxed); y < costs.height;
                 y = nextRow.fetch_add(1, std::memory_order_relaxed)) {
                for (std::uint32_t x = 0; x < costs.width; ++x) *costs.pixel(x, y) = pixelCost(cost, x, y, count);
            }
        });
        return costs;
    }

    app::EngineReport report() const override {
        app::EngineReport report = report_;
        report.engine = policy_ == Policy::Seq ? "single" : "multi";
        report.device = processorName();
        report.threads = threads_;
        report.features = features_;
        report.lightSampling = app::describeLightShapes(settings_, features_);
        report.kernel = std::string(kernel_ == nullptr ? "" : kernel_->name) + "/" + name(set_);
        report.rays = {counters_.camera, counters_.scattered, counters_.shadow, counters_.edge, counters_.reuse};
        report.nonfiniteSamples = counters_.nonfinite;
        report.cutOff = counters_.cutOff;
        report.deviceBytes = film_.bytes() + (scene_ ? scene_->accel->bytes() : 0);
        return report;
    }

  private:
    void begin(const scene::CameraDesc& camera, const app::RenderSettings& settings, Film film) {
        const scene::CompiledScene& s = *scene_->compiled;
        features_ = app::renderFeatures(s, camera, settings);
        kernel_ = &chooseKernel(kernels_, features_);
        settings_ = settings;
        context_ = {&scene_->view, app::makeRenderParams(s, settings),
                    scene::makeCamera(camera, settings.width, settings.height, s.origin)};
        edges_ = app::splitAtEdges(s, context_.camera, settings, context_.params);
        if (context_.params.edgeRays > 0) context_.edges = edges_.parts.data();
        film_ = std::move(film);
        limit_.reset();
        passEnd_ = 0;
        nextTile_ = kNoTile;
        counters_ = {};
        report_.renderDeviceSeconds = 0;
    }

    // Rays or seconds a sample.
    float pixelCost(app::Cost cost, std::uint32_t x, std::uint32_t y, std::uint32_t samples) const {
        using Clock = std::chrono::steady_clock;
        float sum[3] = {};
        KernelCounters counters;
        TileTask task;
        task.x = x;
        task.y = y;
        task.width = task.height = task.stride = 1;
        task.count = samples;
        task.sum = sum;
        const Clock::time_point start = Clock::now();
        kernel_->renderTiles(context_, {&task, 1}, nullptr, counters);
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        const auto rays = static_cast<double>(counters.camera + counters.scattered + counters.shadow + counters.edge);
        return static_cast<float>((cost == app::Cost::Time ? seconds : rays) / samples);
    }

    static constexpr std::uint32_t kNoTile = ~0u; // no pass is in progress

    static bool cancelled(const app::Budget& budget) {
        return budget.cancel != nullptr && budget.cancel->load(std::memory_order_relaxed);
    }

    // Samples of replicate r among the first `total` of a pixel: sample s belongs to replicate s mod R.
    std::uint32_t replicateSamples(std::uint64_t total, std::uint32_t replicate) const {
        const std::uint64_t replicates = settings_.replicates;
        return static_cast<std::uint32_t>((total + replicates - 1 - replicate) / replicates);
    }

    // Samples per pixel that passes lead to in the end, or before there is a plan.
    std::uint64_t goal() const { return limit_ ? *limit_ : image::goalOf(film_, settings_.spp); }

    // Opens the next pass, which takes every pixel to passEnd_ samples, or to what the plan gives it: one more block of
    // each replicate, or more where the plan has left few pixels; where somebody watches, the first passes are short.
    // False: all done, or cancelled.
    bool beginPass(const app::Budget& budget) {
        std::uint64_t next = image::nextSample(film_, tiles_, goal());
        if (next == Film::kNoSample) {
            if (limit_ || !film_.isPilot()) return false;
            std::vector<std::uint32_t> plan =
                image::makeSamplePlan(film_, settings_.spp, app::dependentSide(features_), {threads_, budget.cancel});
            if (plan.empty()) return false;
            film_.setPlan(std::move(plan));
            next = image::nextSample(film_, tiles_, goal());
        }
        const std::uint64_t block = std::uint64_t{Film::kBlock} * settings_.replicates;
        const std::uint64_t blocks = film_.hasPlan() ? 1 + next / block / 2 : 1;
        passEnd_ = std::min((next / block + blocks) * block, goal());
        if (budget.isWatched && !settings_.adaptive) {
            std::uint64_t early = settings_.replicates; // samples
            while (early <= next) early *= 4;
            passEnd_ = std::min(passEnd_, early);
        }
        if (film_.hasPlan() || passEnd_ % block != 0) film_.reserveOpenBlocks();
        nextTile_ = 0;
        return true;
    }

    // Workers take tiles until the pass or the time is over. A tile that was cancelled half-way is not committed, so a
    // later call renders it again.
    void runPass(Clock::time_point deadline, const std::atomic<bool>* cancel) {
        std::atomic<std::uint32_t> next{nextTile_};
        std::atomic<bool> abandoned{false};
        runWorkers(policy_, threads_, [&](std::uint32_t) {
            TileBatch batch(*kernel_, context_, film_, cancel);
            bool isDone = true;
            do {
                const std::uint32_t position = next.fetch_add(1, std::memory_order_relaxed);
                if (position >= tiles_.size()) break;
                for (std::uint32_t replicate = 0; isDone && replicate < settings_.replicates; ++replicate)
                    isDone = batch.add(tiles_[position], replicate, replicateSamples(passEnd_, replicate));
            } while (isDone && !abandoned.load(std::memory_order_relaxed) && Clock::now() < deadline);
            if (!isDone || !batch.flush()) abandoned.store(true, std::memory_order_relaxed);
            addCounters(batch.counters());
        });
        // After an interruption tiles below `next` may be unfinished: the pass starts over, and finished tiles are
        // skipped.
        nextTile_ = abandoned.load() ? 0 : std::min(next.load(), static_cast<std::uint32_t>(tiles_.size()));
    }

    void addCounters(const KernelCounters& counters) {
        const std::scoped_lock lock(countersMutex_);
        counters_.camera += counters.camera;
        counters_.scattered += counters.scattered;
        counters_.shadow += counters.shadow;
        counters_.edge += counters.edge;
        counters_.reuse += counters.reuse;
        counters_.nonfinite += counters.nonfinite;
        counters_.cutOff += counters.cutOff;
    }

    app::RenderStatus status() const {
        app::RenderStatus status;
        status.samplesDone = image::totalSamples(film_, tiles_);
        status.samplesTotal = limit_ ? status.samplesDone + image::missingSamples(film_, tiles_, *limit_)
                                     : image::pixelCount(film_, tiles_) * settings_.spp;
        status.finished = status.samplesDone >= status.samplesTotal;
        return status;
    }

    Policy policy_;
    InstructionSet set_;
    std::span<const Kernel> kernels_;
    std::uint32_t threads_ = 1;

    std::unique_ptr<PreparedScene> scene_;
    app::RenderSettings settings_;
    shared::Features features_;
    const Kernel* kernel_ = nullptr;
    scene::Silhouettes edges_;
    KernelContext context_;

    Film film_;
    image::TileList tiles_;              // of the film, that are to be rendered
    std::optional<std::uint32_t> limit_; // samples per pixel that renderOnly() has asked for
    std::uint64_t passEnd_ = 0;          // samples per pixel that the pass in progress leads to
    std::uint32_t nextTile_ = kNoTile;   // position in tiles_ of the first tile that the pass has not handed out

    std::mutex countersMutex_;
    KernelCounters counters_;
    app::EngineReport report_;
};

} // namespace

std::unique_ptr<app::Engine> makeCpuEngine(const CpuEngineOptions& options) {
    return std::make_unique<CpuEngine>(options);
}

} // namespace rt::cpu
