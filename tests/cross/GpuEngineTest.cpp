// What the GPU engine promises beyond the formulas: repeatable, resumable, indifferent to how work is cut and to forced
// features.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Shared/Base/Features.h"
#include "Common/Vulkan/Buffer.h"
#include "Common/Vulkan/Check.h"
#include "RayTracingGPU/GpuEngine.h"
#include "tests/cross/BoxRender.h"
#include "tests/cross/Device.h"
#include "tests/image/Harness.h"

namespace rt::test {
namespace {

using image::Film;
using image::Image;

constexpr std::uint32_t kSide = 20; // no multiple of a tile's

app::RenderSettings settingsFor(std::uint32_t spp) {
    app::RenderSettings settings;
    settings.width = kSide;
    settings.height = kSide;
    settings.spp = spp;
    return settings;
}

class GpuEngineTest : public ::testing::TestWithParam<app::GpuEngineKind> {};
INSTANTIATE_TEST_SUITE_P(Engines, GpuEngineTest, kFirstEngine, engineName);
INSTANTIATE_TEST_SUITE_P(Nightly, GpuEngineTest, kSecondEngine, engineName);

gpu::GpuEngineOptions testedEngine(std::uint32_t regionSlots = gpu::GpuEngineOptions().regionSlots) {
    gpu::GpuEngineOptions options;
    options.pipelineCache = false;
    options.regionSlots = regionSlots;
    options.engine = GpuEngineTest::GetParam();
    return options;
}

struct Render : BoxRender {
    explicit Render(const app::RenderSettings& settings, const gpu::GpuEngineOptions& options = testedEngine(),
                    vulkan::VulkanContext& context = device())
        : BoxRender(settings, gpu::makeGpuEngine(context, options)) {}
};

// By an engine that is gone then.
Film rendered(const app::RenderSettings& settings, const gpu::GpuEngineOptions& options = testedEngine()) {
    return Render(settings, options).finish();
}

TEST_P(GpuEngineTest, SameSeedSameBits) {
    app::RenderSettings settings = settingsFor(40);
    settings.replicates = 3;
    const std::vector<float> first = rendered(settings).resolve().data;
    const std::vector<float> second = rendered(settings).resolve().data;
    EXPECT_TRUE(sameBits(first, second));
    settings.seed = 1;
    EXPECT_NE(first, rendered(settings).resolve().data);
}

// Through the ray tracing pipeline of an NVIDIA H200 it once had other last bits.
TEST_P(GpuEngineTest, AnEngineBesideAnotherGivesTheSameBits) {
    const app::RenderSettings settings = settingsFor(64);
    Render first(settings);
    const std::vector<float> expected = first.finish().resolve().data;
    Render second(settings);
    EXPECT_TRUE(sameBits(expected, second.finish().resolve().data));
}

TEST_P(GpuEngineTest, GoesOnFromAFilmAsIfNeverStopped) {
    app::RenderSettings settings = settingsFor(75);
    settings.secondMoments = true;
    settings.sampler = app::SamplerKind::Independent; // the strata of others depend on the number of samples
    const Film expected = rendered(settings);

    app::RenderSettings part = settings;
    part.spp = 37; // in the middle of a block
    Film film = rendered(part);
    Render resumed(settings);
    resumed.engine->restore(std::move(film));
    const Film& actual = resumed.finish();
    EXPECT_TRUE(sameBits(expected.resolve().data, actual.resolve().data));
    EXPECT_TRUE(sameBits(expected.varianceOfMean().data, actual.varianceOfMean().data));
    EXPECT_EQ(actual.totalSamples(), std::uint64_t{kSide} * kSide * settings.spp);
}

TEST_P(GpuEngineTest, CountsWhatItDid) {
    Render render(settingsFor(5));
    render.finish();
    const app::EngineReport report = render.engine->report();
    EXPECT_EQ(report.rays.camera, std::uint64_t{kSide} * kSide * 5);
    EXPECT_GT(report.rays.scattered, report.rays.camera / 2);
    EXPECT_GT(report.rays.shadow, 0u);
    const bool compute = GetParam() == app::GpuEngineKind::Compute;
    EXPECT_EQ(report.engine, compute ? "compute" : "pipeline");
    EXPECT_EQ(report.kernel, compute ? "list+quads+spheres" : "paths+quads+spheres");
    EXPECT_GT(report.deviceBytes, 0u);
}

TEST_P(GpuEngineTest, CancelledWorkCanGoOn) {
    const std::vector<float> expected = rendered(settingsFor(40)).resolve().data;
    Render render(settingsFor(40));
    const std::atomic<bool> cancel{true};
    EXPECT_FALSE(render.engine->renderSome({std::chrono::seconds(1), &cancel}).finished);
    EXPECT_EQ(render.engine->film().totalSamples(), 0u);
    EXPECT_TRUE(sameBits(expected, render.finish().resolve().data));
}

// A launch leaves paths to the next one. Until they have ended, its samples are not in the film, which can go on
// without them.
TEST_P(GpuEngineTest, SamplesUnderWayAreNotInTheFilm) {
    app::RenderSettings settings = settingsFor(24);
    settings.width = settings.height = 56; // so many tiles that two launches take different ones
    settings.sampler = app::SamplerKind::Independent;
    const std::vector<float> expected = rendered(settings).resolve().data;

    std::optional<Film> film;
    {
        gpu::GpuEngineOptions options = testedEngine();
        options.launchSeconds = 1e-9;
        Render render(settings, options);
        bool waits = false;
        for (int i = 0; i < 9; ++i) {
            const app::RenderStatus status = render.engine->renderSome({std::chrono::seconds(0), nullptr});
            EXPECT_FALSE(status.finished);
            EXPECT_EQ(render.engine->film().totalSamples(), status.samplesDone);
            waits = waits || status.samplesDone < render.engine->report().rays.camera;
        }
        EXPECT_TRUE(waits);
        film = render.engine->film();
        EXPECT_TRUE(sameBits(expected, render.finish().resolve().data));
    }
    Render resumed(settings);
    resumed.engine->restore(std::move(*film));
    EXPECT_TRUE(sameBits(expected, resumed.finish().resolve().data));
}

// A film that is rendered part by part, in launches of single tiles, in passes that take some tiles far ahead: the same
// bits.
TEST_P(GpuEngineTest, NeitherPartsNorLaunchesShow) {
    app::RenderSettings settings = settingsFor(150);
    settings.replicates = 2;
    settings.secondMoments = true;
    const Film expected = rendered(settings);
    for (const std::uint32_t slots : {1u, 6u, gpu::GpuEngineOptions().regionSlots}) {
        for (const auto& [launch, pass] : {std::pair(1e-9, 0.0), {0.1, 0.0}, {0.1, 1e3}}) {
            gpu::GpuEngineOptions options = testedEngine(slots);
            options.launchSeconds = launch;
            options.passSeconds = pass;
            Render parts(settings, options);
            const Film& actual = parts.finish();
            SCOPED_TRACE(std::to_string(slots) + ", " + std::to_string(launch) + ", " + std::to_string(pass));
            EXPECT_TRUE(sameBits(expected.resolve().data, actual.resolve().data));
            EXPECT_TRUE(sameBits(expected.varianceOfMean().data, actual.varianceOfMean().data));
            EXPECT_EQ(parts.engine->report().rays.camera, std::uint64_t{kSide} * kSide * settings.spp);
        }
    }
}

// Made on the device or, of a film in parts, on the host: in the middle of a block, with several replicates, from a
// film.
TEST_P(GpuEngineTest, ASnapshotIsTheResolvedFilm) {
    const auto expectSame = [](app::Engine& engine) {
        const app::Snapshot snapshot = engine.snapshot();
        const Film& film = engine.film();
        const image::Image expected = film.resolve();
        ASSERT_EQ(snapshot.radiance.data.size(), expected.data.size());
        for (std::size_t i = 0; i < expected.data.size(); ++i) {
            EXPECT_NEAR(snapshot.radiance.data[i], expected.data[i], 3e-7f * expected.data[i]) << i;
        }
        ASSERT_EQ(snapshot.tileSamples.size(), film.tileCount());
        for (std::uint32_t tile = 0; tile < film.tileCount(); ++tile) {
            EXPECT_EQ(snapshot.tileSamples[tile], film.samples(tile));
        }
        EXPECT_EQ(snapshot.minSamples(), film.minSamples());
    };
    for (const std::uint32_t slots : {4u, gpu::GpuEngineOptions().regionSlots}) {
        app::RenderSettings settings = settingsFor(45);
        settings.width = 30;
        settings.replicates = 2;
        settings.sampler = app::SamplerKind::Independent;
        Render render(settings, testedEngine(slots));
        expectSame(*render.engine); // no samples
        render.finish();
        expectSame(*render.engine);
        settings.spp = 64;
        Render resumed(settings, testedEngine(slots));
        resumed.engine->restore(render.engine->film());
        expectSame(*resumed.engine);
        resumed.finish();
        expectSame(*resumed.engine);
    }
}

TEST_P(GpuEngineTest, PartsGoOnFromAFilm) {
    app::RenderSettings settings = settingsFor(150);
    const std::vector<float> expected = rendered(settings).resolve().data;
    app::RenderSettings part = settings;
    part.spp = 37;
    const gpu::GpuEngineOptions options = testedEngine(4);
    Film film = rendered(part, options);
    Render resumed(settings, options);
    resumed.engine->restore(std::move(film));
    EXPECT_TRUE(sameBits(expected, resumed.finish().resolve().data));
}

// ---- failure -------------------------------------------------------------------------------------------------------

class FailingContext : public vulkan::VulkanContext {
  public:
    FailingContext() : VulkanContext({}) {}
    bool lost = false;

  protected:
    void submit(VkCommandBuffer commands, VkFence fence) override {
        if (lost) throw vulkan::DeviceLostError("the device was lost");
        VulkanContext::submit(commands, fence);
    }
};

TEST_P(GpuEngineTest, ALostDeviceLeavesTheLastCopyOfTheFilm) {
    FailingContext context;
    Render render(settingsFor(1u << 30), testedEngine(), context);
    render.engine->renderSome({});
    const Film copy = render.engine->film();
    EXPECT_GT(copy.totalSamples(), 0u);
    EXPECT_GT(render.engine->renderSome({}).samplesDone, copy.totalSamples());
    context.lost = true;
    EXPECT_THROW(render.engine->renderSome({}), RenderError);
    EXPECT_EQ(render.engine->film().totalSamples(), copy.totalSamples());
    EXPECT_TRUE(sameBits(copy.resolve().data, render.engine->film().resolve().data));
    EXPECT_GT(render.engine->report().rays.camera, copy.totalSamples());
}

TEST_P(GpuEngineTest, AFilmThatCannotBeReadIsAnErrorOnce) {
    FailingContext context;
    const app::RenderSettings settings = settingsFor(1u << 30);
    Render render(settings, testedEngine(), context);
    render.engine->renderSome({}); // compiles for so long on a busy machine that the film is copied for safety
    render.engine->reset(render.scene->camera, settings);
    render.engine->renderSome({});
    context.lost = true;
    EXPECT_THROW(render.engine->film(), RenderError);
    EXPECT_EQ(render.engine->film().totalSamples(), 0u);
}

TEST_P(GpuEngineTest, MoreMemoryThanThereIsIsAnError) {
    const VkDeviceSize bytes = device().memory().largest() + 1;
    try {
        const vulkan::Buffer buffer(device().memory(), bytes, 0, vulkan::Memory::Device, "the film");
        FAIL() << bytes << " bytes";
    } catch (const RenderError& error) {
        EXPECT_EQ(std::string(error.what()).rfind("Memory for the film (", 0), 0u) << error.what();
    }
}

// ---- what a scene does not need: ShaderGroupsTest.cpp counts it, and reports name it -------------------------------

TEST_P(GpuEngineTest, KernelsAreNamedByTheirFeatures) {
    const auto kernel = [](const char* id, const app::RenderSettings& settings) {
        const auto scene = app::compile(app::loadScene(id), true);
        const auto engine = gpu::makeGpuEngine(device(), testedEngine());
        engine->setScene(scene, nullptr);
        engine->reset(scene->camera, settings);
        return engine->report().kernel;
    };
    app::RenderSettings settings = settingsFor(1);
    const bool compute = GetParam() == app::GpuEngineKind::Compute;
    const std::string tree = compute ? "tree" : "paths";
    const std::string way = compute ? "list" : "paths";
    EXPECT_EQ(kernel("one-weekend-final", settings), tree + "+spheres");
    EXPECT_EQ(kernel("next-week-quads", settings), way + "+quads");
    settings.features = shared::kFeatureTriangles | shared::kFeatureSpheres;
    EXPECT_EQ(kernel("next-week-quads", settings), way + "+triangles+quads+spheres");
}

TEST_P(GpuEngineTest, FirstHitFeatures) {
    Render render(settingsFor(1));
    const app::AovImages images = render.engine->renderAovs({{true, true, true}}, 4);
    ASSERT_EQ(images.albedo.data.size(), std::size_t{kSide} * kSide * 3);
    ASSERT_EQ(images.depth.data.size(), std::size_t{kSide} * kSide);
    const float* normal = images.normal.pixel(kSide / 2, kSide / 2); // of the back wall
    EXPECT_NEAR(std::hypot(normal[0], normal[1], normal[2]), 1.0f, 0.2f);
    EXPECT_GT(images.depth.pixel(kSide / 2, kSide / 2)[0], 0.0f);
}

TEST_P(GpuEngineTest, DepthIsThatOfWhatIsHit) {
    const auto engine = gpu::makeGpuEngine(device(), testedEngine());
    expectDepthOfWhatIsHit(*engine);
    expectSurfacesInMirrors(*engine);
    expectFeaturesOfTheirOwnSamples(*engine);
    expectFewerSamplesWhereTheyAgree(*engine);
    EXPECT_EQ(device().validationMessages(), 0u);
}

} // namespace
} // namespace rt::test
