#include "RayTracingGPU/MeasuredEngine.h"

#include <algorithm>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "Common/Core/Error.h"
#include "Common/Render/ForwardingEngine.h"
#include "Common/Vulkan/Check.h"
#include "RayTracingGPU/EngineChoice.h"
#include "RayTracingGPU/EngineRates.h"

namespace rt::gpu {
namespace {

using app::EngineRate;
using app::GpuEngineKind;

constexpr std::uint32_t kSide = 256;         // pixels, of what is rendered to measure
constexpr std::uint32_t kEndless = 1u << 30; // samples
// Shaders are compiled late, and clocks rise: launches that do not count come first.
constexpr std::chrono::duration<double> kWarmUp{0.02};
constexpr std::chrono::duration<double> kMeasured{0.04};

double raysOf(const app::EngineReport& report) {
    return static_cast<double>(report.rays.all());
}

// Rays per second of the device's time, of an engine that has the scene.
double measureRate(app::Engine& engine, const scene::CompiledScene& scene, const std::atomic<bool>* cancel) {
    app::RenderSettings settings;
    settings.width = settings.height = kSide;
    settings.spp = kEndless;
    settings.sppIsKnown = false;
    engine.reset(scene.camera, settings);
    engine.renderSome({kWarmUp, cancel});
    const app::EngineReport before = engine.report();
    engine.renderSome({kMeasured, cancel});
    const app::EngineReport after = engine.report();
    const double seconds = after.renderDeviceSeconds - before.renderDeviceSeconds;
    return seconds > 0 ? (raysOf(after) - raysOf(before)) / seconds : 0;
}

const EngineRate& fastest(const std::vector<EngineRate>& rates) {
    return *std::max_element(rates.begin(), rates.end(), [](const EngineRate& a, const EngineRate& b) {
        return a.raysPerSecond < b.raysPerSecond;
    });
}

GpuEngineKind kindOf(const std::string& name) {
    for (const auto& row : app::kGpuEngines)
        if (row.name == name) return row.value;
    return GpuEngineKind::Auto;
}

struct Made {
    GpuEngineKind kind = GpuEngineKind::Auto;
    std::unique_ptr<app::Engine> engine;
};

class MeasuredEngine final : public app::ForwardingEngine {
  public:
    MeasuredEngine(vulkan::VulkanContext& context, const GpuEngineOptions& options)
        : context_(context),
          options_(options),
          kinds_(enginesOf(context.info())),
          rates_(options.pipelineCache ? engineRatesFile() : "") {
        take(make(kinds_.back()));
    }

    bool setScene(std::shared_ptr<const scene::CompiledScene> scene, const std::atomic<bool>* cancel) override {
        const std::string key = ratesKey(context_, *scene);
        std::vector<EngineRate> rates = rates_.find(key);
        std::erase_if(rates, [&](const EngineRate& rate) { return !has(kindOf(rate.engine)); });
        const bool areOfBefore = rates.size() == kinds_.size();
        Made last;
        if (!areOfBefore) {
            rates = measure(scene, cancel, last);
            if (rates.empty()) return false; // cancelled
            rates = rates_.keep(key, rates);
        }
        if (!use(kindOf(fastest(rates).engine), std::move(last), std::move(scene), cancel)) return false;
        measured_ = std::move(rates);
        areOfBefore_ = areOfBefore;
        return true;
    }

    app::EngineReport report() const override {
        app::EngineReport report = engine_->report();
        report.rates = measured_;
        report.ratesAreOfBefore = areOfBefore_;
        return report;
    }

  private:
    bool has(GpuEngineKind kind) const { return std::find(kinds_.begin(), kinds_.end(), kind) != kinds_.end(); }
    Made make(GpuEngineKind kind) const {
        GpuEngineOptions options = options_;
        options.engine = kind;
        return {kind, makeGpuEngine(context_, options)};
    }
    void take(Made made) {
        engine_ = std::move(made.engine);
        kind_ = made.kind;
    }

    // Of all engines; none when cancelled. One that fails, as for want of memory, has no speed. `last` is the last one,
    // with the scene.
    std::vector<EngineRate> measure(const std::shared_ptr<const scene::CompiledScene>& scene,
                                    const std::atomic<bool>* cancel, Made& last) {
        std::vector<EngineRate> rates;
        std::exception_ptr failure;
        bool anyWorks = false;
        for (const GpuEngineKind kind : kinds_) {
            double rate = 0;
            last.engine = nullptr;
            try {
                last = make(kind);
                if (!last.engine->setScene(scene, cancel)) return {};
                rate = measureRate(*last.engine, *scene, cancel);
                if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) return {};
                anyWorks = true;
            } catch (const vulkan::DeviceLostError&) {
                throw;
            } catch (const RenderError&) {
                last.engine = nullptr;
                failure = std::current_exception();
            }
            rates.push_back({app::nameOf(app::kGpuEngines, kind), rate});
        }
        if (!anyWorks) std::rethrow_exception(failure);
        return rates;
    }

    // Renders the scene by this engine from now on: by `last` if it is one, which has the scene. False: cancelled.
    bool use(GpuEngineKind kind, Made last, std::shared_ptr<const scene::CompiledScene> scene,
             const std::atomic<bool>* cancel) {
        if (last.engine && last.kind == kind) {
            take(std::move(last));
            return true;
        }
        last.engine = nullptr;
        if (kind_ == kind) return engine_->setScene(std::move(scene), cancel);
        Made made = make(kind);
        if (!made.engine->setScene(std::move(scene), cancel)) return false;
        take(std::move(made));
        return true;
    }

    vulkan::VulkanContext& context_;
    GpuEngineOptions options_;
    std::vector<GpuEngineKind> kinds_; // of the device
    EngineRates rates_;
    GpuEngineKind kind_ = GpuEngineKind::Auto; // of engine_
    std::vector<EngineRate> measured_;         // by which engine_ was chosen
    bool areOfBefore_ = false;
};

} // namespace

std::unique_ptr<app::Engine> makeMeasuredEngine(vulkan::VulkanContext& context, const GpuEngineOptions& options) {
    return std::make_unique<MeasuredEngine>(context, options);
}

} // namespace rt::gpu
