// How estimated errors compare with the errors that pictures have, over seeds.
#pragma once
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "Common/Image/ErrorEstimate.h"
#include "Common/Image/Metrics.h"
#include "Common/Render/Engine.h"
#include "Common/Render/RenderParams.h"
#include "Common/Scene/CompiledScene.h"

namespace rt::test {

// Of one seed, by its own replicates.
struct EstimatedRun {
    image::Image picture;
    image::RelMseEstimate estimated;
};

inline std::vector<EstimatedRun> renderSeeds(app::Engine& engine, const scene::CompiledScene& scene,
                                             app::RenderSettings settings, std::uint32_t seeds) {
    std::vector<EstimatedRun> runs(seeds);
    for (EstimatedRun& run : runs) {
        ++settings.seed;
        engine.reset(scene.camera, settings);
        while (!engine.renderSome({std::chrono::seconds(1), nullptr}).finished) {
        }
        run.picture = engine.film().resolve();
        run.estimated = image::estimateRelMse(run.picture, engine.film().varianceOfMean(),
                                              app::dependentSide(engine.report().features));
    }
    return runs;
}

// The relMSE of each run, measured against the mean of the other runs, whose own variance is subtracted.
inline std::vector<double> measuredErrors(const std::vector<EstimatedRun>& runs) {
    const std::size_t values = runs[0].picture.data.size();
    const auto seeds = static_cast<double>(runs.size());
    const double others = seeds - 1;
    std::vector<double> measured(runs.size());
    for (std::size_t i = 0; i < values; ++i) {
        double sum = 0, squares = 0;
        for (const EstimatedRun& run : runs) {
            sum += double{run.picture.data[i]};
            squares += double{run.picture.data[i]} * double{run.picture.data[i]};
        }
        const double variance = (squares - sum * sum / seeds) / others;
        for (std::size_t r = 0; r < runs.size(); ++r) {
            const double value = runs[r].picture.data[i], reference = (sum - value) / others;
            const double square = (value - reference) * (value - reference) - variance / others;
            measured[r] += square / (reference * reference + image::kRelativeFloor) / static_cast<double>(values);
        }
    }
    return measured;
}

} // namespace rt::test
