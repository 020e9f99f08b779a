// One render of one film, from its beginning to its end: headless programs, windows and the benchmark drive engines by
// it.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "Common/Image/ErrorEstimate.h"
#include "Common/Render/Engine.h"
#include "Common/Render/Names.h"
#include "Common/Render/Progress.h"

namespace rt::app {

enum class StopReason { Spp, TimeLimit, TargetError, Interrupted, Failure };
inline constexpr Named<StopReason> kStopReasons[] = {{"spp", StopReason::Spp},
                                                     {"time_limit", StopReason::TimeLimit},
                                                     {"target_error", StopReason::TargetError},
                                                     {"interrupted", StopReason::Interrupted},
                                                     {"failure", StopReason::Failure}};

// What a run heeds besides its samples. Time is that of its slices, with the error estimates and checkpoints between
// them.
struct RunLimits {
    std::optional<double> seconds{};     // from now on
    std::optional<double> targetError{}; // the estimated relMSE's confidence interval lies below it
    // In place of the film's own error, where another is meant.
    std::function<std::optional<image::RelMseEstimate>(const image::Film&)> estimate{};
    std::optional<double> saveEvery{}; // seconds between two checkpoints
    std::function<void()> save{};      // writes one
};

// The engine has its scene, outlives the run, and renders no other film meanwhile.
class FilmRun {
  public:
    static constexpr double kSliceSeconds = 0.2; // where nobody waits for a picture

    // Begins a film, or goes on from one that has samples. Throws what the engine throws.
    FilmRun(Engine& engine, const scene::CameraDesc& camera, const RenderSettings& settings, image::Film kept = {});

    // Before the first slice: the rest of the film stays as it is.
    void renderOnly(const image::TileList& tiles);

    // Whether the film may have that many samples per pixel instead: none has more already, and the samples of the
    // others do not depend on the number.
    bool canTake(std::uint32_t spp) const;
    // The film goes on, or may, with the bits that it would have had if so many had been asked for at first. Requires
    // canTake(spp). Throws what the engine throws.
    void setSpp(std::uint32_t spp);

    // Somebody watches the picture: see Budget.
    void watch() { isWatched_ = true; }

    // In place of the limits before; none at first.
    void limit(RunLimits limits);

    // Samples for at most so many seconds. Returns what has ended the run, if anything has; after Interrupted, because
    // `cancel` became true, and after new limits it may go on. Returns within 100 ms once `cancel` is true, if the
    // engine keeps its promise. Throws what the engine throws: what had been committed to the film stays.
    std::optional<StopReason> slice(double seconds, const std::atomic<bool>& cancel);
    StopReason untilStopped(const std::atomic<bool>& cancel); // slices until one ends the run

    Engine& engine() const { return *engine_; }
    const scene::CameraDesc& camera() const { return camera_; }
    const RenderSettings& settings() const { return settings_; }
    const RenderStatus& status() const { return status_; }
    std::uint64_t pixels() const { return std::uint64_t{settings_.width} * settings_.height; }
    EngineReport report() const;                // the engine's, with rays and samples of the whole run
    double seconds() const { return seconds_; } // of sampling alone: neither checkpoints nor error estimates
    std::uint64_t samplesRestored() const { return samplesRestored_; } // over all pixels, of the film it went on from
    ProgressState progress() const;

    // The film as it is, or as the engine last copied it where it cannot be read any more; `lost` then says why.
    const image::Film& keptFilm(std::string& lost) const;

  private:
    bool reachesTargetError();

    Engine* engine_;
    scene::CameraDesc camera_;
    RenderSettings settings_;
    std::uint64_t samplesRestored_ = 0;
    EngineReport before_; // what the engine had counted when it began anew
    RenderStatus status_;
    double seconds_ = 0;
    double elapsed_ = 0; // of all that slice() does
    RunLimits limits_;
    double limit_ = 0, nextSave_ = 0; // in elapsed seconds
    double nextCheck_ = 0;            // of the error, in samples
    bool wasBelowTarget_ = false;     // at the last one
    bool isWatched_ = false;
};

} // namespace rt::app
