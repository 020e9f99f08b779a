// Measurements with an engine whose samples are known.
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "Common/App/SceneSource.h"
#include "Common/Bench/Analysis.h"
#include "Common/Bench/Energy.h"
#include "Common/Bench/Measurement.h"
#include "Common/Bench/ReferenceStore.h"
#include "Common/Bench/Runner.h"
#include "tests/TempFolder.h"
#include "tests/unit/FakeEngine.h"

namespace rt::bench {
namespace {

using app::FakeEngine;
using test::TempFolder;

const std::atomic<bool> kGoOn{false};

std::shared_ptr<const scene::CompiledScene> someScene() {
    return app::compile(app::loadScene("one-weekend-default"), true, true);
}

app::RenderSettings small() {
    app::RenderSettings settings;
    settings.width = 16;
    settings.height = 16;
    return settings;
}

// The mean of samples 0 to spp - 1 of FakeEngine.
float meanOf(std::uint32_t spp, std::uint32_t seed) {
    double sum = 0;
    for (std::uint32_t s = 0; s < spp; ++s) sum += FakeEngine::value(3, 5, 1, s, seed);
    return static_cast<float>(sum / spp);
}

TEST(BenchMeasurement, SnapshotsHoldTheImageAfterExactlyThatManySamples) {
    FakeEngine engine;
    const auto run = measure(engine, *someScene(), small(), {{1, 3, 20}, {}, 1e30}, 7, kGoOn);
    ASSERT_EQ(run.snapshots.size(), 3u);
    const std::uint32_t spp[] = {1, 3, 20};
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(run.snapshots[i].spp, spp[i]);
        EXPECT_NEAR(run.snapshots[i].image.pixel(3, 5)[1], meanOf(spp[i], 7), 1e-6f);
        EXPECT_GT(run.snapshots[i].seconds, i > 0 ? run.snapshots[i - 1].seconds : 0.0); // of all its samples
    }
}

TEST(BenchMeasurement, StopsAndLimits) {
    FakeEngine engine;
    EXPECT_TRUE(measure(engine, *someScene(), small(), {{1, 3}, {}, 0}, 0, kGoOn).snapshots.size() ==
                1u); // 3 take too long
    std::atomic<bool> stop{false};
    std::uint32_t resets = 0;
    engine.onSample = [&](std::uint32_t spp) { stop = stop || (spp == 17 && ++resets > 0); };
    const auto run = measure(engine, *someScene(), small(), {{16, 32}, {}, 1e30}, 0, stop);
    EXPECT_EQ(run.snapshots.size(), 1u); // what was interrupted is left out
}

TEST(BenchMeasurement, TimeBudgetsGiveWhatTheTimeAllows) {
    FakeEngine engine;
    const auto run = measure(engine, *someScene(), small(), {{}, {0.005, 0.02}, 1e30}, 0, kGoOn);
    ASSERT_EQ(run.snapshots.size(), 2u);
    EXPECT_EQ(run.snapshots[0].timeBudget, 0.005);
    EXPECT_GE(run.snapshots[1].spp, run.snapshots[0].spp);
}

TEST(BenchReference, IsAsGoodAsWhatIsMeasuredAsksFor) {
    const auto scene = someScene();
    FakeEngine engine;
    const auto run = measure(engine, *scene, small(), {{16, 64}, {}, 1e30}, 0, kGoOn);
    ReferenceStore store({}, false);
    const ReferenceRequest request{scene.get(), 16, 16, 50, 60, 32};
    const image::Image* images[] = {&run.snapshots[0].image, &run.snapshots[1].image};
    const auto made = store.provide(request, images, engine, kGoOn);
    ASSERT_TRUE(made);
    EXPECT_TRUE(made->sufficient);
    EXPECT_FALSE(made->cached);
    EXPECT_GE(made->spp, 9u * 64u); // variance at most a ninth
    // Samples are uniform in [0,1]: variance 1/12. What is measured against 0.5 and against the reference agrees.
    const image::ErrorAnalysis error = image::analyseError(run.snapshots[1].image, made->reference);
    EXPECT_NEAR(error.mse, 1.0 / 12 / 64, 4 * 1.0 / 12 / 64 * std::sqrt(2.0 / (16 * 16 * 3)) * 1.1);
    EXPECT_NEAR(error.referenceMse, 1.0 / 12 / static_cast<double>(made->spp),
                0.2 / 12 / static_cast<double>(made->spp));
}

TEST(BenchReference, IsKeptAndExtendedAndGuarded) {
    const TempFolder folder;
    const auto scene = someScene();
    FakeEngine engine;
    const image::Image coarse = measure(engine, *scene, small(), {{4}, {}, 1e30}, 0, kGoOn).snapshots[0].image;
    const image::Image fine = measure(engine, *scene, small(), {{64}, {}, 1e30}, 0, kGoOn).snapshots[0].image;
    ReferenceStore store(folder.path(), false);
    ReferenceRequest request{scene.get(), 16, 16, 50, 60, 64};
    const image::Image* first[] = {&coarse};
    const image::Image* second[] = {&fine};
    const auto made = store.provide(request, first, engine, kGoOn);
    const auto again = store.provide(request, first, engine, kGoOn);
    const auto better = store.provide(request, second, engine, kGoOn);
    ASSERT_TRUE(made && again && better);
    EXPECT_TRUE(again->cached);
    EXPECT_EQ(again->spp, made->spp);
    EXPECT_EQ(again->reference.mean.data, made->reference.mean.data);
    EXPECT_TRUE(better->cached);
    EXPECT_GT(better->spp, made->spp);
    ReferenceStore none({}, false);
    request.firstSpp = better->spp;
    const auto whole = none.provide(request, second, engine, kGoOn);
    EXPECT_EQ(whole->reference.mean.data, better->reference.mean.data); // as if made at once

    std::ofstream(store.fileOf(request), std::ios::binary | std::ios::in).write("damage", 6);
    const auto repaired = store.provide(request, first, engine, kGoOn);
    ASSERT_TRUE(repaired);
    EXPECT_FALSE(repaired->cached);
    EXPECT_FALSE(ReferenceStore(folder.path(), true).provide(request, first, engine, kGoOn)->cached);
}

TEST(BenchReference, AnotherImageHasAnotherFile) {
    const auto scene = someScene();
    const ReferenceStore store("folder", false);
    const ReferenceRequest request{scene.get(), 16, 16, 50, 60, 64};
    ReferenceRequest wider = request, deeper = request, elsewhere = request;
    wider.width = 17;
    deeper.maxDepth = 51;
    scene::CompiledScene moved = *scene;
    moved.camera.lookFrom.x += 1;
    elsewhere.scene = &moved;
    EXPECT_EQ(store.fileOf(request), store.fileOf(request));
    EXPECT_NE(store.fileOf(request), store.fileOf(wider));
    EXPECT_NE(store.fileOf(request), store.fileOf(deeper));
    EXPECT_NE(store.fileOf(request), store.fileOf(elsewhere));
}

Suite someSuite() {
    return parseSuite(
        R"({"version": 1, "experiments": [{"name": "e", "scene": "one-weekend-default", "engine": ["multi", "compute"],
        "width": 16, "height": 16, "sampler": ["sobol", "independent"], "features": ["auto", "all"], "spp": [4, 16],
        "repeats": 3, "baseline": {"sampler": "independent"}}]})",
        "s.json");
}

std::vector<EngineKind> fakeKinds() {
    return {{"multi", [](std::uint32_t) { return std::make_unique<FakeEngine>(); }, ""}};
}

TEST(BenchRunner, RowsForEachCombinationAndStep) {
    Engines engines(fakeKinds());
    ReferenceStore store({}, false);
    std::vector<std::string> said;
    const RunnerHooks hooks{[&](const std::string& text) { said.push_back(text); }, {}};
    const Results results = runSuite(someSuite(), engines, store, hooks, kGoOn);
    EXPECT_TRUE(results.complete);
    ASSERT_EQ(results.rows.size(), 2u * 2 * 2);
    for (const Row& row : results.rows) {
        EXPECT_EQ(row.repeats, 3);
        ASSERT_TRUE(row.mse && row.efficiency && row.gain && row.speedup);
        EXPECT_NEAR(*row.mse, 1.0 / 12 / *row.spp, 0.3 / 12 / *row.spp);
        EXPECT_GT(*row.mseCi, 0);
        EXPECT_LT(std::abs(*row.biasZ), 4);
    }
    ASSERT_EQ(results.series.size(), 4u);
    for (const Series& series : results.series) EXPECT_NEAR(*series.slope, -1, 0.3);
    ASSERT_EQ(results.skips.size(), 2u); // one for each sampler
    EXPECT_EQ(results.skips[0].differingPixels, 0);
    ASSERT_EQ(results.references.size(), 1u);
    EXPECT_TRUE(results.references[0].sufficient);
    ASSERT_EQ(results.notices.size(), 1u); // there is no compute engine
    EXPECT_NE(results.notices[0].find("compute"), std::string::npos);
    EXPECT_FALSE(said.empty());
    EXPECT_FALSE(results.grids.empty());
}

TEST(BenchRunner, KeepsWhatWasMeasuredBeforeAnInterruption) {
    std::atomic<bool> stop{false};
    Engines engines({{"multi",
                      [&](std::uint32_t) {
                          auto engine = std::make_unique<FakeEngine>();
                          auto* raw = engine.get();
                          engine->onSample = [&stop, raw](std::uint32_t) { stop = raw->calls > 200; };
                          return engine;
                      },
                      ""}});
    ReferenceStore store({}, false);
    const Results results = runSuite(someSuite(), engines, store, {[](const std::string&) {}, {}}, stop);
    EXPECT_FALSE(results.complete);
    EXPECT_FALSE(results.rows.empty());
}

TEST(BenchAnalysis, ComparesAtEqualTimeAndAtEqualError) {
    const Experiment experiment = someSuite().experiments.front();
    std::vector<Row> rows;
    for (const bool independent : {false, true})
        for (const double spp : {4.0, 16.0}) {
            Row row;
            row.experiment = "e";
            row.config.settings.sampler = independent ? app::SamplerKind::Independent : app::SamplerKind::Sobol;
            row.spp = spp;
            row.seconds = spp * (independent ? 0.5 : 1); // twice as fast,
            row.mse = (independent ? 8 : 1) / spp;       // and eight times as noisy
            row.relmse = row.mse;
            row.efficiency = 1 / (*row.mse * *row.seconds);
            row.samplesPerSecond = spp / *row.seconds;
            rows.push_back(row);
        }
    addBaselines(experiment, rows);
    EXPECT_DOUBLE_EQ(rows[0].speedup.value(), 0.5);
    EXPECT_DOUBLE_EQ(rows[0].gain.value(), 4);
    EXPECT_DOUBLE_EQ(rows[2].gain.value(), 1);
    const std::vector<Series> series = makeSeries(experiment, rows);
    ASSERT_EQ(series.size(), 2u);
    EXPECT_NEAR(series[0].slope.value(), -1, 1e-12);
    EXPECT_DOUBLE_EQ(series[0].equalTime.value(), 8); // both come so far
    EXPECT_NEAR(series[0].relmseAtEqualTime.value(), 1.0 / 8, 1e-12);
    EXPECT_NEAR(series[1].relmseAtEqualTime.value(), 0.5, 1e-12);
    EXPECT_NEAR(series[0].equalError.value(), 0.5, 1e-12);
    EXPECT_NEAR(series[0].secondsAtEqualError.value(), 2, 1e-12);
    EXPECT_NEAR(series[1].secondsAtEqualError.value(), 8, 1e-12);
    EXPECT_NEAR(series[0].gain.value(), 4, 1e-12);
    EXPECT_NEAR(series[0].secondsTo1e2.value(), 100, 1e-9);
}

TEST(BenchEnergy, ReadsPackagesAndCountersThatWrap) {
    const TempFolder folder;
    const auto write = [&](const std::string& zone, const std::string& file, const std::string& text) {
        std::filesystem::create_directories(folder.path() / zone);
        std::ofstream(folder.path() / zone / file) << text;
    };
    for (const char* zone : {"intel-rapl:0", "intel-rapl:1", "intel-rapl:0:0"}) {
        write(zone, "energy_uj", "900000");
        write(zone, "max_energy_range_uj", "1000000");
    }
    const EnergyMeter meter(folder.path());
    write("intel-rapl:0", "energy_uj", "950000");
    write("intel-rapl:1", "energy_uj", "100000"); // wrapped
    ASSERT_TRUE(meter.joules());
    EXPECT_NEAR(*meter.joules(), 0.05 + 0.2, 1e-9); // a part of a package is not counted twice
    EXPECT_FALSE(EnergyMeter(folder.path() / "nowhere").joules());
}

} // namespace
} // namespace rt::bench
