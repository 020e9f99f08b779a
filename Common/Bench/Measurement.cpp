#include "Common/Bench/Measurement.h"

#include <algorithm>
#include <functional>
#include <ostream>

#include "Common/App/Platform.h"
#include "Common/App/Session/RenderLoop.h"
#include "Common/Image/Summary.h"

namespace rt::bench {
namespace {

constexpr double kWarmUpSeconds = 0.25;         // at most
constexpr std::uint32_t kWarmUpSpp = 16;        // one block
constexpr double kDeviceWarmUpSeconds = 0.5;    // at least: an idle GPU may wait before it raises its clocks; then
constexpr double kDeviceSlice = 0.06;           // it is ready when a slice of this many seconds
constexpr double kStillRising = 1.03;           // has less than so many times the samples of the one before,
constexpr double kMostDeviceWarmUpSeconds = 1;  // or after this time
constexpr std::uint32_t kUnknownSpp = 1u << 30; // of a render that ends by time
constexpr double kTimedSeconds = 0.25;          // a run that takes less is timed again,
constexpr std::size_t kMostPasses = 9;          // so many times at most

app::RayCounts operator+(const app::RayCounts& a, const app::RayCounts& b) {
    return {a.camera + b.camera, a.scattered + b.scattered, a.shadow + b.shadow};
}

// Of one step, from run to run.
struct Times {
    std::vector<double> wall, device, processor;

    void add(const Snapshot& snapshot) {
        wall.push_back(snapshot.seconds);
        device.push_back(snapshot.deviceSeconds);
        processor.push_back(snapshot.processorSeconds);
    }
    void putMedians(Snapshot& snapshot) const {
        snapshot.seconds = image::median(wall);
        snapshot.deviceSeconds = image::median(device);
        snapshot.processorSeconds = image::median(processor);
    }
};

class Measurer {
  public:
    Measurer(app::Engine& engine, const scene::CompiledScene& scene, const app::RenderSettings& settings,
             const std::atomic<bool>& stop, const EnergyCounter& deviceEnergy)
        : engine_(engine),
          scene_(scene),
          stop_(stop),
          deviceEnergy_(deviceEnergy),
          silence_(nullptr),
          progress_(silence_, app::Progress::Style::Silent) {
        options_.settings = settings;
    }

    void warmUp() {
        const bool device = engine_.report().threads == 0;
        app::Options options = options_;
        options.settings.spp = device ? kUnknownSpp : kWarmUpSpp;
        options.settings.sppIsKnown = !device;
        options.timeLimit = device ? kDeviceSlice : kWarmUpSeconds;
        engine_.reset(scene_.camera, options.settings);
        std::uint64_t done = 0; // samples
        double rate = 0;
        for (double seconds = 0; seconds < kMostDeviceWarmUpSeconds;) {
            const app::RenderResult slice = app::renderUntilStopped(engine_, options, done, stop_, progress_, [] {});
            if (!device || slice.stoppedBy == app::StopReason::Interrupted) return;
            const double now = static_cast<double>(slice.progress.samplesDone - done) / slice.seconds;
            done = slice.progress.samplesDone;
            seconds += slice.seconds;
            if (seconds >= kDeviceWarmUpSeconds && now < kStillRising * rate) return;
            rate = now;
        }
    }

    // What takes a moment is timed several times over, since chance has a large part in the time of one.
    void toSamples(const Ladder& ladder) {
        std::vector<Times> times;
        climb(ladder, [&](std::size_t) {
            take(std::nullopt);
            times.emplace_back().add(done_);
        });
        run_.report = engine_.report();
        double spent = done_.seconds;
        for (std::size_t pass = 1; pass < kMostPasses && spent < kTimedSeconds && !stop_; ++pass) {
            climb(ladder, [&](std::size_t step) {
                if (step < times.size()) times[step].add(done_);
            });
            spent += done_.seconds;
        }
        for (std::size_t step = 0; step < times.size(); ++step) times[step].putMedians(run_.snapshots[step]);
    }

    void toSeconds(const Ladder& ladder) {
        options_.settings.spp = kUnknownSpp;
        options_.settings.sppIsKnown = false;
        engine_.reset(scene_.camera, options_.settings);
        for (const double seconds : ladder.seconds) {
            if (seconds > ladder.maxSeconds) return;
            options_.timeLimit = seconds - done_.seconds;
            if (*options_.timeLimit > 0 && !step()) return;
            take(seconds);
        }
        run_.report = engine_.report();
    }

    Run finish() { return std::move(run_); }

  private:
    // From the first sample on; `reached` is told the number of each step that was done in time.
    void climb(const Ladder& ladder, const std::function<void(std::size_t)>& reached) {
        const bool anew = options_.settings.sampler == app::SamplerKind::Stratified;
        done_ = {};
        for (std::size_t i = 0; i < ladder.spp.size(); ++i) {
            const std::uint32_t spp = ladder.spp[i];
            const double perSample = done_.spp > 0 ? done_.seconds / static_cast<double>(done_.spp) : 0;
            if (perSample * spp > ladder.maxSeconds) return;
            image::Film film = anew || done_.spp == 0 ? image::Film() : engine_.film();
            if (anew) done_ = {};
            options_.settings.spp = spp;
            engine_.reset(scene_.camera, options_.settings);
            if (done_.spp > 0) engine_.restore(std::move(film));
            options_.timeLimit =
                done_.spp > 0 ? std::nullopt : std::optional(ladder.maxSeconds); // nothing tells as yet
            if (!step()) return;
            done_.spp = spp;
            reached(i);
        }
    }

    // False: interrupted, or not done in time.
    bool step() {
        const app::EngineReport before = engine_.report(); // a reset has set its counts to 0
        const EnergyMeter energy;
        const auto deviceJoules = [this] { return deviceEnergy_ ? deviceEnergy_() : std::nullopt; };
        const std::optional<double> deviceBefore = deviceJoules();
        const double processorBefore = app::processorSeconds();
        const app::RenderResult result =
            app::renderUntilStopped(engine_, options_, engine_.film().totalSamples(), stop_, progress_, [] {});
        if (result.stoppedBy == app::StopReason::Interrupted) return false;
        if (result.stoppedBy == app::StopReason::TimeLimit && options_.settings.sppIsKnown) return false;
        if (const auto joules = energy.joules()) done_.joules = done_.joules.value_or(0) + *joules;
        if (const auto joules = deviceJoules(); joules && deviceBefore)
            done_.joulesGpu = done_.joulesGpu.value_or(0) + *joules - *deviceBefore;
        const app::EngineReport after = engine_.report();
        done_.seconds += result.seconds;
        done_.processorSeconds += app::processorSeconds() - processorBefore;
        done_.deviceSeconds += after.renderDeviceSeconds - before.renderDeviceSeconds;
        done_.rays = done_.rays + app::RayCounts{after.rays.camera - before.rays.camera,
                                                 after.rays.scattered - before.rays.scattered,
                                                 after.rays.shadow - before.rays.shadow};
        return true;
    }

    void take(std::optional<double> timeBudget) {
        const image::Film& film = engine_.film();
        done_.spp = film.minSamples();
        done_.samples = film.totalSamples();
        done_.timeBudget = timeBudget;
        run_.snapshots.push_back(done_);
        run_.snapshots.back().image = film.resolve();
    }

    app::Engine& engine_;
    const scene::CompiledScene& scene_;
    const std::atomic<bool>& stop_;
    const EnergyCounter& deviceEnergy_;
    std::ostream silence_;
    app::Progress progress_;
    app::Options options_;
    Snapshot done_; // so far; without image
    Run run_;
};

} // namespace

Run measure(app::Engine& engine, const scene::CompiledScene& scene, app::RenderSettings settings, const Ladder& ladder,
            std::uint32_t seed, const std::atomic<bool>& stop, const EnergyCounter& deviceEnergy) {
    settings.seed = seed;
    Measurer measurer(engine, scene, settings, stop, deviceEnergy);
    measurer.warmUp();
    if (!stop) ladder.seconds.empty() ? measurer.toSamples(ladder) : measurer.toSeconds(ladder);
    return measurer.finish();
}

} // namespace rt::bench
