// Samples until something says stop.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>

#include "Common/App/Options/Names.h"
#include "Common/App/Options/Options.h"
#include "Common/App/Session/Engine.h"
#include "Common/App/Session/Progress.h"

namespace rt::app {

enum class StopReason { Spp, TimeLimit, TargetError, Interrupted, Failure };
inline constexpr Named<StopReason> kStopReasons[] = {{"spp", StopReason::Spp},
                                                     {"time_limit", StopReason::TimeLimit},
                                                     {"target_error", StopReason::TargetError},
                                                     {"interrupted", StopReason::Interrupted},
                                                     {"failure", StopReason::Failure}};

struct RenderResult {
    StopReason stoppedBy = StopReason::Spp;
    double seconds = 0; // of sampling alone: neither checkpoints nor error estimates
    ProgressState progress;
};

// The engine has been reset, and restored where `samplesRestored` (over all pixels) is not 0. `save` is called every
// options.saveEvery seconds. Returns within 100 ms once `stop` is true, if the engine keeps its promise.
RenderResult renderUntilStopped(Engine& engine, const Options& options, std::uint64_t samplesRestored,
                                const std::atomic<bool>& stop, Progress& progress, const std::function<void()>& save);

} // namespace rt::app
