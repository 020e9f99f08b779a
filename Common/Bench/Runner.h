// Runs a suite: scene by scene, configurations taking turns, references behind the measurements that they serve.
#pragma once
#include <atomic>
#include <functional>
#include <string>

#include "Common/Bench/Engines.h"
#include "Common/Bench/RankedRun.h"
#include "Common/Bench/ReferenceStore.h"
#include "Common/Bench/Results.h"
#include "Common/Bench/Suite.h"

namespace rt::bench {

struct RunnerHooks {
    std::function<void(const std::string&)> say; // one line on what happens
    // Rays per second that the processor's hardware can do with this scene's rays alone, by another library, on all
    // threads; nothing where that is not known. May be empty.
    std::function<Figure(const scene::CompiledScene&)> rayCeiling;
    RankLauncher launcher = {}; // of configurations of several ranks
};

// What was measured when `stop` becomes true is returned, with complete == false. Engines that are not there are left
// out with a notice, and so are configurations that fail (Results::failure). Throws InputError, before anything is
// measured, for a scene that cannot be read.
Results runSuite(const Suite& suite, Engines& engines, ReferenceStore& references, const RunnerHooks& hooks,
                 const std::atomic<bool>& stop);

} // namespace rt::bench
