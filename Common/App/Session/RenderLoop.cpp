#include "Common/App/Session/RenderLoop.h"

#include <algorithm>

#include "Common/App/Session/FilmEstimate.h"
#include "Common/App/Session/Stopwatch.h"

namespace rt::app {
namespace {

constexpr double kSliceSeconds = 0.2; // of one call of the engine
constexpr double kCheckGrowth = 1.1;  // samples between two looks at the error

// Whether the estimated error has fallen below the target. Looks only when there are 10 % more samples than the last
// time, so that looking costs little and chance gets few opportunities.
class ErrorTarget {
  public:
    explicit ErrorTarget(const std::optional<double>& target) : target_(target) {}

    bool reached(Engine& engine, std::uint64_t samplesDone) {
        if (!target_ || static_cast<double>(samplesDone) < next_) return false;
        next_ = kCheckGrowth * static_cast<double>(samplesDone);
        const auto relmse = estimate(engine.film()).relmse;
        return relmse && *relmse < *target_;
    }

  private:
    std::optional<double> target_;
    double next_ = 1;
};

} // namespace

RenderResult renderUntilStopped(Engine& engine, const Options& options, std::uint64_t samplesRestored,
                                const std::atomic<bool>& stop, Progress& progress, const std::function<void()>& save) {
    const double limit = options.timeLimit.value_or(1e30);
    const double saveEvery = options.saveEvery.value_or(1e30);
    ErrorTarget target(options.targetError);
    RenderResult result;
    result.progress.samplesRestored = samplesRestored;
    result.progress.pixels = std::uint64_t{options.settings.width} * options.settings.height;
    result.progress.timeLimit = options.timeLimit;

    const Stopwatch total;
    double nextSave = saveEvery;
    while (true) {
        const double slice = std::clamp(limit - total.seconds(), 0.0, kSliceSeconds);
        const Stopwatch sampling;
        const RenderStatus status = engine.renderSome({std::chrono::duration<double>(slice), &stop});
        result.seconds += sampling.seconds();

        result.progress.samplesDone = status.samplesDone;
        result.progress.samplesTotal = status.samplesTotal;
        result.progress.seconds = total.seconds();
        progress.update(result.progress);

        const auto stopped = [&result](StopReason reason) {
            result.stoppedBy = reason;
            return result;
        };
        if (status.finished) return stopped(StopReason::Spp);
        if (stop) return stopped(StopReason::Interrupted);
        if (total.seconds() >= limit) return stopped(StopReason::TimeLimit);
        if (target.reached(engine, status.samplesDone)) return stopped(StopReason::TargetError);
        if (total.seconds() >= nextSave) {
            save();
            nextSave = total.seconds() + saveEvery;
        }
    }
}

} // namespace rt::app
