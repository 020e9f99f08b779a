// What more threads bring: the renderer's samples per second and, as the yardstick for this machine, Embree's rays per
// second, each on one thread and on many. The four take turns, so that a busy machine disturbs all alike.
//   scaling-bench [REPEATS] [THREADS] [SCENE]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Parallel.h"
#include "Common/Core/RunMain.h"
#include "Common/Image/Summary.h"
#include "Common/Render/Stopwatch.h"
#include "RayTracingCPU/CpuEngine.h"
#include "tests/bench/EmbreeCeiling.h"

namespace rt::bench {
namespace {

constexpr double kWarmUp = 0.1; // seconds: clocks, caches
constexpr double kSeconds = 1;  // of a measurement of Embree

// The renderer on so many threads.
class Renderer {
  public:
    Renderer(std::shared_ptr<const scene::CompiledScene> scene, std::uint32_t threads)
        : scene_(std::move(scene)), engine_(cpu::makeCpuEngine({.threads = threads})) {
        engine_->setScene(scene_, nullptr);
        settings_.width = settings_.height = 600;
        settings_.spp = image::Film::kBlock;
    }

    // Of the whole image: its parts differ, and in a given time more threads get to more of them.
    double samplesPerSecond() {
        engine_->reset(scene_->camera, settings_);
        engine_->renderSome({std::chrono::duration<double>(kWarmUp), nullptr});
        engine_->reset(scene_->camera, settings_);
        const app::Stopwatch watch;
        while (!engine_->renderSome({std::chrono::duration<double>(kSeconds), nullptr}).finished) {
        }
        return static_cast<double>(engine_->film().totalSamples()) / watch.seconds();
    }

  private:
    std::shared_ptr<const scene::CompiledScene> scene_;
    std::unique_ptr<app::Engine> engine_;
    app::RenderSettings settings_;
};

// Rays per second over as long a time.
double raysPerSecond(EmbreeRays& embree, std::size_t threads) {
    double secondsPerRay = 0;
    int passes = 0;
    for (const app::Stopwatch watch; watch.seconds() < kSeconds; ++passes) secondsPerRay += 1 / embree.trace(threads);
    return passes / secondsPerRay;
}

int run(const std::vector<std::string>& arguments) {
    const auto number = [&](std::size_t i, int otherwise) {
        return arguments.size() > i ? std::max(1, std::atoi(arguments[i].c_str())) : otherwise;
    };
    const int repeats = number(0, 7);
    const auto threads = static_cast<std::uint32_t>(number(1, static_cast<int>(threadCount(0))));
    const std::string name = arguments.size() > 2 ? arguments[2] : "cornell-box-lights";
    const auto scene = app::compile(app::loadScene(name), true);
    std::optional<EmbreeRays> embree = EmbreeRays::make(*scene);
    Renderer one(scene, 1), many(scene, threads);
    std::vector<double> ours[2], theirs[2], ratios;
    for (int i = 0; i < repeats; ++i) {
        ours[0].push_back(one.samplesPerSecond());
        ours[1].push_back(many.samplesPerSecond());
        if (!embree) continue;
        theirs[0].push_back(raysPerSecond(*embree, 1));
        theirs[1].push_back(raysPerSecond(*embree, threads));
        ratios.push_back(ours[1].back() / ours[0].back() / (theirs[1].back() / theirs[0].back()));
    }
    const auto report = [&](const char* what, const std::vector<double>(&rates)[2]) {
        std::printf("%-22s %8.2f M/s on 1 thread, %8.2f on %u: %.3f times\n", what, 1e-6 * image::median(rates[0]),
                    1e-6 * image::median(rates[1]), threads, image::median(rates[1]) / image::median(rates[0]));
    };
    std::printf("%s, 600x600; medians of %d\n", name.c_str(), repeats);
    report("samples", ours);
    if (!embree) return 0;
    report("rays through Embree", theirs);
    std::printf("ours over Embree's: %.3f, from %.3f to %.3f\n", image::median(ratios),
                *std::min_element(ratios.begin(), ratios.end()), *std::max_element(ratios.begin(), ratios.end()));
    return 0;
}

} // namespace
} // namespace rt::bench

int main(int argc, char** argv) {
    return rt::runMain("scaling-bench", [&] { return rt::bench::run({argv + std::min(argc, 1), argv + argc}); });
}
