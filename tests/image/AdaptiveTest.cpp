// Adaptive sampling by the CPU engine: the same bits for any scheduling and interruption, an exact budget, and the mean
// of uniform samples.
#include <array>
#include <atomic>
#include <chrono>
#include <optional>
#include <sstream>

#include "Common/App/Session/FilmRun.h"
#include "Common/Image/SamplePlan.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "tests/image/Harness.h"
#include "tests/unit/Statistics.h"

namespace rt::test {
namespace {

using namespace std::chrono_literals;
using image::Film;

app::RenderSettings adaptiveSettings(std::uint32_t side, std::uint32_t spp, std::uint32_t replicates = 2) {
    app::RenderSettings settings;
    settings.width = settings.height = side;
    settings.spp = spp;
    settings.replicates = replicates;
    settings.adaptive = true;
    return settings;
}

struct Render {
    std::shared_ptr<const scene::CompiledScene> scene =
        scene::compileScene(scene::findBuiltinScene("cornell-box-lights"));
    std::unique_ptr<app::Engine> engine;

    explicit Render(const app::RenderSettings& settings, const cpu::CpuEngineOptions& options = {})
        : engine(cpu::makeCpuEngine(options)) {
        engine->setScene(scene, nullptr);
        engine->reset(scene->camera, settings);
    }
    const Film& finish() {
        while (!engine->renderSome({1s, nullptr}).finished) {
        }
        return engine->film();
    }
};

TEST(CpuAdaptive, TheImageDependsOnNeitherThreadsNorPolicy) {
    for (const app::SamplerKind sampler : {app::SamplerKind::Sobol, app::SamplerKind::SobolBlue}) {
        app::RenderSettings settings = adaptiveSettings(37, 50);
        settings.sampler = sampler;
        const std::vector<float> expected = Render(settings, {cpu::Policy::Seq, 1}).finish().resolve().data;
        for (const std::uint32_t threads : {2u, 7u})
            EXPECT_TRUE(sameBits(expected, Render(settings, {cpu::Policy::Par, threads}).finish().resolve().data));
    }
}

TEST(CpuAdaptive, EveryNumberOfSamplesIsExact) {
    for (const std::uint32_t spp : {16u, 33u, 75u})
        for (const std::uint32_t replicates : {2u, 4u, 6u}) {
            Render render(adaptiveSettings(11, spp, replicates));
            const Film& film = render.finish();
            EXPECT_TRUE(film.hasPlan());
            EXPECT_EQ(film.totalSamples(), 121u * spp);
            EXPECT_EQ(film.samplesPerPixel(), spp);
            EXPECT_EQ(render.engine->report().rays.camera, 121u * spp);
        }
}

// A tile or two at a time; a new engine goes on from a copy of what there is now and then: in the pilot, where it ends,
// after it.
TEST(CpuAdaptive, InterruptionsDoNotShow) {
    const app::RenderSettings settings = adaptiveSettings(24, 100);
    const std::vector<float> expected = Render(settings).finish().resolve().data;
    Render slow(settings);
    bool wasPilot = false, wasPlanned = false;
    for (std::uint32_t slice = 0; !slow.engine->renderSome({0s, nullptr}).finished; ++slice) {
        const Film& film = slow.engine->film();
        const bool isPilotDone =
            film.isPilot() && film.nextSample(image::pilotSamples(settings.spp)) == Film::kNoSample;
        if (slice % 13 != 3 && !isPilotDone) continue;
        (film.hasPlan() ? wasPlanned : wasPilot) = true;
        std::stringstream state;
        film.writeState(state);
        Render resumed(settings);
        resumed.engine->restore(Film::readState(film.desc(), state, "state"));
        EXPECT_TRUE(sameBits(expected, resumed.finish().resolve().data)) << slice;
    }
    EXPECT_TRUE(wasPilot && wasPlanned);
    EXPECT_TRUE(sameBits(expected, slow.engine->film().resolve().data));
}

// Of the quarters of the picture, over 60 seeds: a bias of four standard errors of the difference would show, which is
// about 3 % of the mean. The bias of a wrong rule is found in SamplePlanTest.cpp.
TEST(CpuAdaptive, TheMeanIsThatOfUniformSamples) {
    constexpr std::uint32_t kSide = 16, kSeeds = 60;
    Mean differences[4];
    app::RenderSettings settings = adaptiveSettings(kSide, 16);
    Render render(settings);
    const auto quarters = [&](bool adaptive, std::uint32_t seed) {
        settings.adaptive = adaptive;
        settings.seed = seed;
        render.engine->reset(render.scene->camera, settings);
        const image::Image picture = render.finish().resolve();
        std::array<double, 4> sums{};
        for (std::uint32_t y = 0; y < kSide; ++y)
            for (std::uint32_t x = 0; x < kSide; ++x)
                for (std::uint32_t c = 0; c < 3; ++c)
                    sums[y / (kSide / 2) * 2 + x / (kSide / 2)] += static_cast<double>(picture.pixel(x, y)[c]);
        return sums;
    };
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
        const auto adaptive = quarters(true, seed), uniform = quarters(false, seed + kSeeds);
        for (std::size_t i = 0; i < 4; ++i) differences[i].add(adaptive[i] - uniform[i]);
    }
    for (const Mean& difference : differences) EXPECT_TRUE(agrees(difference, 0));
}

// All uniform samples leave the interval's upper end at 1.9e-4. A tile at a time, so that looks at the error come at
// the same samples in every run.
TEST(CpuAdaptive, ReachesATargetErrorThatUniformSamplesMiss) {
    const std::atomic<bool> goOn{false};
    const auto scene = scene::compileScene(scene::findBuiltinScene("next-week-simple-light"));
    const auto engine = cpu::makeCpuEngine({cpu::Policy::Seq, 1});
    engine->setScene(scene, nullptr);
    for (const bool adaptive : {false, true}) {
        app::RenderSettings settings = adaptiveSettings(64, 256, app::kErrorReplicates);
        settings.height = 36;
        settings.adaptive = adaptive;
        app::FilmRun run(*engine, scene->camera, settings);
        run.limit({.targetError = 1.5e-4});
        std::optional<app::StopReason> reason;
        while (!reason) reason = run.slice(0, goOn);
        EXPECT_EQ(*reason, adaptive ? app::StopReason::TargetError : app::StopReason::Spp);
        EXPECT_EQ(engine->film().hasPlan(), adaptive);
    }
}

} // namespace
} // namespace rt::test
