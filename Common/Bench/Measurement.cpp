#include "Common/Bench/Measurement.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "Common/App/Platform.h"
#include "Common/App/Session/OpenImageDenoise.h"
#include "Common/Image/Summary.h"
#include "Common/Render/FilmRun.h"
#include "Common/Render/PictureDenoiser.h"
#include "Common/Render/RenderParams.h"
#include "Common/Render/Stopwatch.h"

namespace rt::bench {
namespace {

constexpr std::uint32_t kHalves = 2;            // that a filter needs
constexpr double kWarmUpSeconds = 0.25;         // at most
constexpr std::uint32_t kWarmUpSpp = 16;        // one block
constexpr double kDeviceWarmUpSeconds = 0.5;    // at least: an idle GPU may wait before it raises its clocks; then
constexpr double kDeviceSlice = 0.06;           // it is ready when a slice of this many seconds
constexpr double kStillRising = 1.03;           // has less than so many times the samples of the one before,
constexpr double kMaxDeviceWarmUpSeconds = 1;   // or after this time
constexpr std::uint32_t kUnknownSpp = 1u << 30; // of a render that ends by time
constexpr double kTimedSeconds = 0.25;          // a run that takes less is timed again,
constexpr std::size_t kMaxPasses = 9;           // so many times at most

// Of one step, from run to run.
struct Times {
    std::vector<double> wall, device, processor, denoise;

    void add(const Snapshot& snapshot) {
        wall.push_back(snapshot.seconds);
        device.push_back(snapshot.deviceSeconds);
        processor.push_back(snapshot.processorSeconds);
        denoise.push_back(snapshot.secondsDenoise);
    }
    void putMedians(Snapshot& snapshot) const {
        snapshot.secondsDenoise = image::median(denoise);
        snapshot.seconds = image::median(wall) + snapshot.secondsDenoise;
        snapshot.deviceSeconds = image::median(device);
        snapshot.processorSeconds = image::median(processor);
    }
};

class Measurer {
  public:
    Measurer(app::Engine& engine, const scene::CompiledScene& scene, const app::RenderSettings& settings,
             Denoise denoise, const std::atomic<bool>& stop, const EnergyCounter& deviceEnergy)
        : engine_(engine),
          scene_(scene),
          settings_(settings),
          denoise_(denoise),
          stop_(stop),
          deviceEnergy_(deviceEnergy) {
        if (denoise != Denoise::Off) settings_.replicates = std::max(settings_.replicates, kHalves);
    }

    void warmUp() {
        const bool device = engine_.report().threads == 0;
        app::RenderSettings settings = settings_;
        settings.spp = device ? kUnknownSpp : kWarmUpSpp;
        settings.sppIsKnown = !device;
        settings.adaptive = false;
        app::FilmRun film(engine_, scene_.camera, settings);
        double rate = 0;
        while (film.seconds() < kMaxDeviceWarmUpSeconds) {
            const std::uint64_t samples = film.status().samplesDone;
            const double seconds = film.seconds();
            film.limit({.seconds = device ? kDeviceSlice : kWarmUpSeconds});
            if (film.untilStopped(stop_) == app::StopReason::Interrupted) return;
            if (!device) break;
            const double now = static_cast<double>(film.status().samplesDone - samples) / (film.seconds() - seconds);
            if (film.seconds() >= kDeviceWarmUpSeconds && now < kStillRising * rate) break;
            rate = now;
        }
        filter();
    }

    // What takes a moment is timed several times over, since chance has a large part in the time of one.
    void toSamples(const Ladder& ladder) {
        std::vector<Times> times;
        climb(ladder, [&](std::size_t) {
            take(std::nullopt);
            times.emplace_back().add(done_);
        });
        run_.report = engine_.report();
        double spent = done_.seconds + filtered_;
        for (std::size_t pass = 1; pass < kMaxPasses && spent < kTimedSeconds && !stop_; ++pass) {
            climb(ladder, [&](std::size_t step) {
                if (step < times.size()) times[step].add(done_);
            });
            spent += done_.seconds + filtered_;
        }
        for (std::size_t step = 0; step < times.size(); ++step) times[step].putMedians(run_.snapshots[step]);
    }

    void toSeconds(const Ladder& ladder) {
        settings_.spp = kUnknownSpp;
        settings_.sppIsKnown = false;
        film_.emplace(engine_, scene_.camera, settings_);
        for (const double seconds : ladder.seconds) {
            if (seconds > ladder.maxSeconds) return;
            if (seconds > done_.seconds && !step(seconds - done_.seconds)) return;
            if (!filter()) continue; // one of the halves lacks samples in some pixel as yet
            take(seconds);
            run_.snapshots.back().seconds += done_.secondsDenoise;
        }
        run_.report = engine_.report();
    }

    Run finish() { return std::move(run_); }

  private:
    // From the first sample on; `reached` is told the number of each step that was done in time.
    void climb(const Ladder& ladder, const std::function<void(std::size_t)>& reached) {
        const bool anew = settings_.sampler == app::SamplerKind::Stratified || settings_.adaptive;
        const std::uint32_t replicates = settings_.replicates;
        done_ = {};
        filtered_ = 0;
        for (std::size_t i = 0; i < ladder.spp.size(); ++i) {
            const std::uint32_t spp = ladder.spp[i];
            const double perSample = done_.spp > 0 ? done_.seconds / static_cast<double>(done_.spp) : 0;
            if (perSample * spp > ladder.maxSeconds) return;
            image::Film film = anew || done_.spp == 0 ? image::Film() : engine_.film();
            if (anew) done_ = {};
            settings_.spp = spp;
            settings_.replicates = replicates;
            app::settleReplicates(settings_);
            film_.emplace(engine_, scene_.camera, settings_, std::move(film));
            if (!step(done_.spp > 0 ? std::nullopt : std::optional(ladder.maxSeconds))) return; // nothing tells as yet
            done_.spp = spp;
            if (!filter()) return;
            filtered_ += done_.secondsDenoise;
            reached(i);
        }
    }

    // False: interrupted, or not done in time.
    bool step(std::optional<double> timeLimit) {
        const app::EngineReport before = engine_.report(); // a reset has set its counts to 0
        const EnergyMeter energy;
        const auto deviceJoules = [this] { return deviceEnergy_ ? deviceEnergy_() : std::nullopt; };
        const std::optional<double> deviceBefore = deviceJoules();
        const double processorBefore = app::processorSeconds();
        const double secondsBefore = film_->seconds();
        film_->limit({.seconds = timeLimit});
        const app::StopReason reason = film_->untilStopped(stop_);
        if (reason == app::StopReason::Interrupted) return false;
        if (reason == app::StopReason::TimeLimit && settings_.sppIsKnown) return false;
        if (const auto joules = energy.joules()) done_.joules = done_.joules.value_or(0) + *joules;
        if (const auto joules = deviceJoules(); joules && deviceBefore)
            done_.joulesGpu = done_.joulesGpu.value_or(0) + *joules - *deviceBefore;
        const app::EngineReport after = engine_.report();
        done_.seconds += film_->seconds() - secondsBefore;
        done_.processorSeconds += app::processorSeconds() - processorBefore;
        done_.deviceSeconds += after.renderDeviceSeconds - before.renderDeviceSeconds;
        done_.rays += after.rays - before.rays;
        return true;
    }

    // False: interrupted, or there are no two halves of the samples in every pixel as yet.
    bool filter() {
        if (denoise_ == Denoise::Off) return true;
        if (denoise_ == Denoise::Oidn) return filterByLibrary();
        const auto quality = denoise_ == Denoise::On ? app::DenoiseQuality::Final : app::DenoiseQuality::Live;
        // Made anew, since it keeps the features, whose time counts.
        auto filtered = engine_.makeDenoiser()->denoise({quality}, stop_);
        if (!filtered) return false;
        picture_ = std::move(filtered->images.picture);
        done_.secondsDenoise = filtered->seconds;
        done_.estimatedRelmse.reset();
        if (quality == app::DenoiseQuality::Final) done_.estimatedRelmse = filtered->images.relmse.value;
        return true;
    }

    bool filterByLibrary() {
        const image::Film& film = engine_.film();
        if (film.minSamples() == 0) return false;
        const app::Stopwatch watch;
        app::AovImages features = engine_.renderAovs({{true, true, false}}, app::kAovSamples);
        picture_ =
            app::OpenImageDenoise().filter(film.resolve(), std::move(features.albedo), std::move(features.normal));
        done_.secondsDenoise = watch.seconds();
        return !stop_;
    }

    void take(std::optional<double> timeBudget) {
        const image::Film& film = engine_.film();
        done_.spp = film.samplesPerPixel();
        done_.samples = film.totalSamples();
        done_.timeBudget = timeBudget;
        run_.snapshots.push_back(done_);
        run_.snapshots.back().image = denoise_ == Denoise::Off ? film.resolve() : picture_;
    }

    app::Engine& engine_;
    const scene::CompiledScene& scene_;
    app::RenderSettings settings_;
    Denoise denoise_;
    const std::atomic<bool>& stop_;
    const EnergyCounter& deviceEnergy_;
    std::optional<app::FilmRun> film_;
    Snapshot done_;       // so far; without image
    double filtered_ = 0; // seconds, on all steps of a climb
    image::Image picture_;
    Run run_;
};

} // namespace

Run measure(app::Engine& engine, const scene::CompiledScene& scene, app::RenderSettings settings, const Ladder& ladder,
            std::uint32_t seed, const std::atomic<bool>& stop, const EnergyCounter& deviceEnergy) {
    settings.seed = seed;
    Measurer measurer(engine, scene, settings, ladder.denoise, stop, deviceEnergy);
    measurer.warmUp();
    if (!stop) ladder.seconds.empty() ? measurer.toSamples(ladder) : measurer.toSeconds(ladder);
    return measurer.finish();
}

} // namespace rt::bench
