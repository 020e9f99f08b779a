// One render, timed, with its image at several numbers of samples on the way.
#pragma once
#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "Common/Bench/Config.h"
#include "Common/Bench/Energy.h"
#include "Common/Render/Engine.h"
#include "Common/Scene/CompiledScene.h"

namespace rt::bench {

// Where to look: at these samples per pixel, or after these seconds of sampling; ascending. And at what: the picture as
// it is, or filtered, for which samples are taken in two halves.
struct Ladder {
    std::vector<std::uint32_t> spp;
    std::vector<double> seconds;
    double maxSeconds = 1e30; // no step that would probably end later is begun, and the first is given up then
    Denoise denoise = Denoise::Off;
};

struct Snapshot {
    std::uint64_t spp = 0;            // of each pixel; the least of all where time ran out
    std::uint64_t samples = 0;        // over all pixels
    std::optional<double> timeBudget; // seconds, where that was asked for
    double seconds = 0;               // wall time of sampling and filtering, warm-up excluded
    double secondsDenoise = 0;        // of these: features and filter
    double deviceSeconds = 0;         // in kernels
    double processorSeconds = 0;      // of all threads of this program
    app::RayCounts rays;
    std::optional<double> joules;          // of the processor package
    std::optional<double> joulesGpu;       // of the device, whose counter moves in steps
    std::optional<double> estimatedRelmse; // by the denoiser, if it tells
    image::Image image;
};

struct Run {
    std::vector<Snapshot> snapshots;
    app::EngineReport report; // of its end
};

// `engine` has the scene; `settings` are complete but for spp and seed. A short render beforehand warms up caches,
// clocks and shaders that drivers compile late. Samplers that lay out strata for a known number of samples are started
// anew for each step. The times of a short run (not of one to time budgets) are medians over several of the same seed.
// When `stop` becomes true, the step in progress is left out. `deviceEnergy` may be empty.
Run measure(app::Engine& engine, const scene::CompiledScene& scene, app::RenderSettings settings, const Ladder& ladder,
            std::uint32_t seed, const std::atomic<bool>& stop, const EnergyCounter& deviceEnergy = {});

} // namespace rt::bench
