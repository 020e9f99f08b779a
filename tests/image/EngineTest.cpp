// What the CPU engine promises whatever it renders: the same bits for any scheduling, kernel or interruption.
#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <mutex>
#include <set>
#include <sstream>
#include <thread>

#include "Common/Accel/Traverse/RayQuery.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Shared/Base/Features.h"
#include "RayTracingCPU/Workers.h"
#include "tests/image/Harness.h"

namespace rt::test {
namespace {

using namespace std::chrono_literals;

std::shared_ptr<const scene::CompiledScene> builtin(const char* id) {
    return scene::compileScene(scene::findBuiltinScene(id));
}

app::RenderSettings plainSettings(std::uint32_t side, std::uint32_t spp) {
    app::RenderSettings settings;
    settings.width = settings.height = side;
    settings.spp = spp;
    return settings;
}

void finish(app::Engine& engine) {
    while (!engine.renderSome({1s, nullptr}).finished) {
    }
}

std::vector<float> renderBits(const scene::CompiledScene& scene, const app::RenderSettings& settings,
                              const cpu::CpuEngineOptions& options = {}) {
    const auto engine = cpu::makeCpuEngine(options);
    engine->setScene(std::shared_ptr<const scene::CompiledScene>(std::shared_ptr<void>(), &scene), nullptr);
    engine->reset(scene.camera, settings);
    finish(*engine);
    return engine->film().resolve().data;
}

TEST(CpuEngine, TheImageDependsOnNeitherThreadsNorPolicy) {
    for (const char* id : {"cornell-box-lights", "one-weekend-final"}) {
        const auto scene = builtin(id);
        const auto settings = plainSettings(37, 20);
        const auto expected = renderBits(*scene, settings, {cpu::Policy::Seq, 1});
        for (auto policy : {cpu::Policy::Par, cpu::Policy::ParUnseq}) {
            for (std::uint32_t threads : {1u, 2u, 7u}) {
                EXPECT_TRUE(sameBits(expected, renderBits(*scene, settings, {policy, threads})))
                    << id << " " << threads;
            }
        }
    }
}

// Two workers that wait for each other can only both arrive when they run at the same time.
TEST(CpuEngine, ParallelPoliciesUseMoreThanOneThread) {
    for (auto policy : {cpu::Policy::Par, cpu::Policy::ParUnseq}) {
        std::atomic<int> arrived{0};
        std::mutex mutex;
        std::set<std::thread::id> threads;
        cpu::runWorkers(policy, 2, [&](std::uint32_t) {
            arrived.fetch_add(1);
            const auto deadline = std::chrono::steady_clock::now() + 20s;
            while (arrived.load() < 2 && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
            const std::scoped_lock lock(mutex);
            threads.insert(std::this_thread::get_id());
        });
        EXPECT_EQ(threads.size(), 2u);
    }
}

// x86-64-v2 has no fused operations to trace rays with, so that a few paths part from their twins.
TEST(NightlyInstructionSets, RenderTheSameImage) {
    std::size_t compared = 0;
    for (const char* id : {"cornell-box-lights", "next-week-cornell-smoke"}) {
        const auto scene = builtin(id);
        const auto settings = plainSettings(24, 16);
        const auto expected = renderBits(*scene, settings);
        for (auto set : {InstructionSet::X86_64_v2, InstructionSet::X86_64_v3}) {
            if (set > bestInstructionSet() || accel::rayQuery(set) == nullptr) continue;
            compared += set != bestInstructionSet();
            const auto found = renderBits(*scene, settings, {cpu::Policy::Par, 0, set});
            std::size_t near = 0;
            for (std::size_t i = 0; i < found.size(); ++i)
                near += std::abs(found[i] - expected[i]) <= 1e-3f * expected[i];
            EXPECT_GT(near, found.size() * 95 / 100) << id << " " << name(set);
            EXPECT_TRUE(set < InstructionSet::X86_64_v3 || sameBits(expected, found)) << id << " " << name(set);
        }
    }
    EXPECT_TRUE(compared > 0 || bestInstructionSet() == InstructionSet::X86_64_v2)
        << "built for one instruction set; ./build.sh test --all builds all (RT_KERNELS=all)";
}

TEST(CpuEngine, MoreFeaturesThanNeededChangeNothing) {
    for (const char* id : {"cornell-box-lights", "one-weekend-final", "rest-of-life-cornell-box-glass"}) {
        const auto scene = builtin(id);
        app::RenderSettings settings = plainSettings(24, 16);
        const auto expected = renderBits(*scene, settings);
        settings.features = shared::kFeatureAll;
        EXPECT_TRUE(sameBits(expected, renderBits(*scene, settings))) << id;
    }
}

TEST(CpuEngine, CostsAreTheRaysOfTheRenderAndTime) {
    const auto scene = builtin("cornell-box-lights");
    const auto engine = cpu::makeCpuEngine({cpu::Policy::Par, 2});
    engine->setScene(scene, nullptr);
    engine->reset(scene->camera, plainSettings(12, 8));
    finish(*engine);
    const app::RayCounts rays = engine->report().rays;
    double sum = 0;
    for (const float cost : engine->renderCost(app::Cost::Rays, 8).data) sum += std::round(8.0 * cost);
    EXPECT_EQ(sum, static_cast<double>(rays.all() - rays.reuse));
    for (const float cost : engine->renderCost(app::Cost::Time, 8).data) EXPECT_GT(cost, 0);
}

TEST(CpuEngine, DepthIsThatOfWhatIsHit) {
    expectDepthOfWhatIsHit(*cpu::makeCpuEngine({}));
}

TEST(CpuEngine, MirrorsShowTheSurfacesInThem) {
    expectSurfacesInMirrors(*cpu::makeCpuEngine({}));
}

TEST(CpuEngine, FeaturesKnowNothingOfThePicturesNoise) {
    expectFeaturesOfTheirOwnSamples(*cpu::makeCpuEngine({}));
}

TEST(CpuEngine, FeaturesTakeFewerSamplesWhereTheyAgree) {
    expectFewerSamplesWhereTheyAgree(*cpu::makeCpuEngine({}));
}

// Lengths in binary floating point scale exactly by powers of two: any absolute tolerance would show.
TEST(CpuEngine, ScalingByAPowerOfTwoIsExact) {
    const scene::SceneDesc desc = scene::findBuiltinScene("cornell-box-lights");
    const auto settings = plainSettings(24, 16);
    const auto expected = renderBits(*scene::compileScene(desc), settings);
    for (int exponent : {-20, -13, 4, 13}) {
        const double factor = std::ldexp(1.0, exponent);
        scene::SceneDesc scaled = desc;
        scaled.objects = {scene::ObjectDesc{scene::GroupDesc{{scene::Scale{glm::dvec3(factor)}}, desc.objects}}};
        scaled.camera.lookFrom *= factor;
        scaled.camera.lookAt *= factor;
        scaled.camera.focusDistance *= factor;
        EXPECT_TRUE(sameBits(expected, renderBits(*scene::compileScene(scaled), settings))) << "2^" << exponent;
    }
}

TEST(CpuEngine, InterruptionsDoNotShow) {
    const auto scene = builtin("cornell-box-lights");
    const auto settings = plainSettings(64, 37);
    const auto expected = renderBits(*scene, settings);
    const auto engine = cpu::makeCpuEngine({});
    engine->setScene(scene, nullptr);
    engine->reset(scene->camera, settings);
    std::atomic<bool> cancel{false};
    bool finished = false;
    // In the end it is long enough for a tile, however slow.
    for (std::chrono::microseconds wait = 3ms; !finished; wait += wait / 8) {
        cancel = false;
        const auto interruption = std::async(std::launch::async, [&cancel, wait] {
            std::this_thread::sleep_for(wait);
            cancel = true;
        });
        finished = engine->renderSome({10s, &cancel}).finished;
    }
    EXPECT_TRUE(sameBits(expected, engine->film().resolve().data));
}

// Whoever watches gets a sample of each replicate in every pixel first, and the same film in the end.
TEST(CpuEngine, AWatchedFilmHasItsFirstSamplesSoonAndTheSameBits) {
    const auto scene = builtin("cornell-box-lights");
    auto settings = plainSettings(37, 50);
    settings.replicates = 2;
    const std::vector<float> expected = renderBits(*scene, settings);
    const auto engine = cpu::makeCpuEngine({cpu::Policy::Seq, 1});
    engine->setScene(scene, nullptr);
    engine->reset(scene->camera, settings);
    const app::Budget oneTile{0s, nullptr, true};
    std::uint64_t maxBefore = 0; // samples of any pixel, while some pixel has none of a replicate
    while (!engine->renderSome(oneTile).finished)
        if (engine->film().minReplicateSamples() == 0) maxBefore = engine->film().maxSamples();
    EXPECT_EQ(maxBefore, 2u);
    EXPECT_TRUE(sameBits(expected, engine->film().resolve().data));
}

// A film that stopped at 21 samples, inside of a block, goes on as if it had not.
TEST(CpuEngine, ResumesInTheMiddleOfABlock) {
    const auto scene = builtin("cornell-box-lights");
    const auto expected = renderBits(*scene, plainSettings(32, 50));
    const auto engine = cpu::makeCpuEngine({});
    engine->setScene(scene, nullptr);
    engine->reset(scene->camera, plainSettings(32, 21));
    finish(*engine);
    std::stringstream state;
    engine->film().writeState(state);
    image::Film film = image::Film::readState(engine->film().desc(), state, "state");
    engine->reset(scene->camera, plainSettings(32, 50));
    engine->restore(std::move(film));
    finish(*engine);
    EXPECT_TRUE(sameBits(expected, engine->film().resolve().data));
}

TEST(CpuEngine, EveryNumberOfSamplesIsExact) {
    const auto scene = builtin("cornell-box-lights");
    for (auto sampler : {app::SamplerKind::Independent, app::SamplerKind::Stratified, app::SamplerKind::Sobol}) {
        for (std::uint32_t spp : {1u, 2u, 3u, 10u, 16u, 17u, 33u}) {
            for (std::uint32_t replicates : {1u, 4u}) {
                app::RenderSettings settings = plainSettings(9, spp);
                settings.sampler = sampler;
                settings.replicates = replicates;
                const auto engine = cpu::makeCpuEngine({});
                engine->setScene(scene, nullptr);
                engine->reset(scene->camera, settings);
                finish(*engine);
                EXPECT_EQ(engine->film().totalSamples(), 81u * spp);
                EXPECT_EQ(engine->report().rays.camera, 81u * spp);
            }
        }
    }
}

} // namespace
} // namespace rt::test
