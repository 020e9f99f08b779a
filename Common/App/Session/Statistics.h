// What a render did, as the JSON object of the interface contract.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "Common/App/Options/Options.h"
#include "Common/App/Session/DenoiseFilm.h"
#include "Common/Image/Film.h"
#include "Common/Image/Metrics.h"
#include "Common/Render/Engine.h"
#include "Common/Render/FilmRun.h"
#include "Common/Scene/CompiledScene.h"

namespace rt::app {

struct Seconds {
    double load = 0;   // scene, assets, compilation
    double render = 0; // wall time of sampling alone
    double write = 0;  // images
};

// How a window answered while it rendered.
struct WindowFigures {
    double framesPerSecond = 0; // drawn in the last second; there is none without something new to show
    double medianTurn = 0;      // seconds that the window's thread takes for a frame; of the last ten seconds
    double longestTurn = 0;     // of all but the first, which builds the interface
    double slowestAnswer = 0;   // seconds from a change of camera or settings to the first picture of it
};

struct Statistics {
    StopReason stoppedBy = StopReason::Spp;
    Seconds seconds;
    std::uint64_t samplesRestored = 0;        // over all pixels, from a checkpoint
    std::optional<image::ErrorFigures> error; // against the reference
    std::optional<double> flip;               // the same
    std::optional<DenoiseFigures> denoised;   // none unless the outputs were denoised
    std::vector<std::string> outputs;         // files written
    std::optional<WindowFigures> window;      // none without one

    // One JSON object, version 1. What cannot be told, as an error estimate without second moments, is null.
    std::string toJson(const Options& options, const scene::CompiledScene& scene, const EngineReport& report,
                       const image::Film& film) const;
};

} // namespace rt::app
