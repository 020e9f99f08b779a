// Measurements with an engine whose samples are known.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Bench/Analysis.h"
#include "Common/Bench/Energy.h"
#include "Common/Bench/Measurement.h"
#include "Common/Bench/ReferenceStore.h"
#include "Common/Bench/Runner.h"
#include "Common/Core/Error.h"
#include "tests/TempFolder.h"
#include "tests/unit/FakeEngine.h"

namespace rt::bench {
namespace {

using app::FakeEngine;
using app::kGoOn;
using test::TempFolder;

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
                1u);                                                                               // 3 take too long
    EXPECT_TRUE(measure(engine, *someScene(), small(), {{2}, {}, 0}, 0, kGoOn).snapshots.empty()); // and 2, in two goes
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

// A device that consumes a joule between two looks.
TEST(BenchMeasurement, DeviceEnergyIsTheCountersRise) {
    FakeEngine engine;
    double joules = 1000;
    const EnergyCounter counter = [&] { return joules++; };
    const auto run = measure(engine, *someScene(), small(), {{1, 3}, {}, 1e30}, 0, kGoOn, counter);
    ASSERT_EQ(run.snapshots.size(), 2u);
    EXPECT_EQ(run.snapshots[0].joulesGpu, 1.0);
    EXPECT_EQ(run.snapshots[1].joulesGpu, 2.0);
    EXPECT_FALSE(measure(engine, *someScene(), small(), {{1}, {}, 1e30}, 0, kGoOn).snapshots[0].joulesGpu);
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
    const image::ErrorAnalysis error = image::analyseError(run.snapshots[1].image, made->reference, 1);
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
        EXPECT_EQ(row.shareUpTo1, 1.0); // of the fake engine's pixels: both errors are the same
        EXPECT_EQ(row.mseUpTo1, row.mse);
        EXPECT_EQ(row.mseUpTo1Ci, row.mseCi);
        EXPECT_EQ(row.efficiencyUpTo1, row.efficiency);
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

TEST(BenchRunner, AFailureLosesNothingElse) {
    std::vector<EngineKind> kinds = fakeKinds();
    int made = 0;
    kinds.push_back({"compute",
                     [&](std::uint32_t) -> std::unique_ptr<app::Engine> {
                         ++made;
                         throw RenderError("the device is lost");
                     },
                     ""});
    Engines engines(kinds);
    ReferenceStore store({}, false);
    const Results results = runSuite(someSuite(), engines, store, {[](const std::string&) {}, {}}, kGoOn);
    EXPECT_TRUE(results.complete);
    EXPECT_EQ(results.rows.size(), 8u); // those of the other engine
    EXPECT_TRUE(std::all_of(results.rows.begin(), results.rows.end(), [](const Row& row) { return bool(row.mse); }));
    EXPECT_EQ(made, 4); // no repeat is tried in vain
    ASSERT_EQ(results.notices.size(), 4u);
    EXPECT_NE(results.notices[0].find("the device is lost"), std::string::npos);
    EXPECT_THROW(std::rethrow_exception(results.failure), RenderError);
}

TEST(BenchRunner, EverySceneIsReadBeforeAnythingIsMeasured) {
    Suite suite = someSuite();
    suite.experiments.push_back(suite.experiments.front());
    suite.experiments.back().values.front().second = {"no-such-scene"};
    int made = 0;
    Engines engines({{"multi", [&](std::uint32_t) { return ++made, std::make_unique<FakeEngine>(); }, ""}});
    ReferenceStore store({}, false);
    EXPECT_THROW(runSuite(suite, engines, store, {[](const std::string&) {}, {}}, kGoOn), InputError);
    EXPECT_EQ(made, 0);
}

TEST(BenchRunner, NoticesSayWhyThereIsNothing) {
    const auto noticesOf = [](const std::string& axes) {
        Engines engines(fakeKinds());
        ReferenceStore store({}, false);
        const Suite suite = parseSuite(R"({"version": 1, "experiments": [{"name": "e", "scene": "one-weekend-default",
            "width": 16, "error": false, )" +
                                           axes + "}]}",
                                       "s.json");
        std::string all;
        for (const std::string& notice :
             runSuite(suite, engines, store, {[](const std::string&) {}, {}}, kGoOn).notices)
            all += notice;
        return all;
    };
    EXPECT_EQ(noticesOf(R"("spp": 1)"), "");
    EXPECT_NE(noticesOf(R"("spp": 4, "max_spp": {"multi": 2})").find("max_spp"), std::string::npos);
    EXPECT_NE(noticesOf(R"("spp": 1, "threads": 4096)").find("more threads"), std::string::npos);
    EXPECT_NE(noticesOf(R"("spp": 1, "baseline": {"sampler": "independent"})").find("baseline"), std::string::npos);
}

TEST(BenchAnalysis, ThreadsAreBusyWhereTheProcessorRanThem) {
    Measured measured;
    bench::Run& run = measured.runs.emplace_back();
    run.report.threads = 2;
    for (const double seconds : {0.01, 2.0}) {
        Snapshot& snapshot = run.snapshots.emplace_back();
        snapshot.seconds = seconds;
        snapshot.processorSeconds = 1.5 * seconds;
    }
    const std::vector<Row> rows = makeRows(someSuite().experiments.front(), measured);
    EXPECT_FALSE(rows[0].busy); // too short to tell
    EXPECT_DOUBLE_EQ(rows[1].busy.value(), 0.75);
    EXPECT_GT(app::processorSeconds(), 0);
}

TEST(BenchAnalysis, APictureWithHolesHasNoError) {
    Measured measured;
    for (const std::uint64_t spp : {2, 0}) {
        Snapshot& snapshot = measured.runs.emplace_back().snapshots.emplace_back();
        snapshot.spp = spp;
        snapshot.seconds = 1;
        snapshot.image = image::Image(16, 16, 3);
    }
    const image::Reference reference{image::Image(16, 16, 3), image::Image(16, 16, 3)};
    std::vector<Row> rows = makeRows(someSuite().experiments.front(), measured);
    addErrors(rows, measured, reference);
    EXPECT_FALSE(rows[0].mse);
    measured.runs.back().snapshots[0].spp = 2;
    addErrors(rows, measured, reference);
    EXPECT_EQ(rows[0].mse, 0.0);
}

TEST(BenchRunner, ReadingALargeSceneIsCalledOff) {
    const Suite suite = parseSuite(R"({"version": 1, "experiments": [{"name": "e", "scene": "white-spheres:10000000",
        "spp": 1, "error": false}]})",
                                   "s.json");
    Engines engines(fakeKinds());
    ReferenceStore store({}, false);
    std::atomic<bool> stop{true};
    EXPECT_FALSE(runSuite(suite, engines, store, {[](const std::string&) {}, {}}, stop).complete);
    stop = false;
    std::thread other([&] { stop = true; }); // about when it begins
    const Results results = runSuite(suite, engines, store, {[](const std::string&) {}, {}}, stop);
    other.join();
    EXPECT_FALSE(results.complete);
    EXPECT_FALSE(results.failure);
}

TEST(BenchAnalysis, EnergyIsTheMedianOfTheRepeatsThatKnowIt) {
    Measured measured;
    for (const std::optional<double> joules : {std::optional(30.0), std::optional<double>(), std::optional(10.0)}) {
        bench::Run run;
        for (const double seconds : {0.5, 2.0}) {
            Snapshot& snapshot = run.snapshots.emplace_back();
            snapshot.seconds = seconds;
            snapshot.joules = joules;
            snapshot.joulesGpu = joules;
        }
        measured.runs.push_back(run);
    }
    const std::vector<Row> rows = makeRows(someSuite().experiments.front(), measured);
    EXPECT_EQ(rows[0].joules, 20.0);
    EXPECT_FALSE(rows[0].joulesGpu); // too short for a counter that moves in steps
    EXPECT_EQ(rows[1].joulesGpu, 20.0);
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

TEST(BenchEnergy, DevicesAreNamedAsTheirDriverDoes) {
    std::array<std::uint8_t, 16> uuid{};
    for (std::size_t i = 0; i < uuid.size(); ++i) uuid[i] = static_cast<std::uint8_t>(17 * i);
    EXPECT_EQ(nvidiaUuid(uuid), "GPU-00112233-4455-6677-8899-aabbccddeeff");
}

TEST(BenchEnergy, NoSuchDeviceIsSilentlyAbsent) {
    EXPECT_FALSE(NvidiaEnergy({}).joules());
    EXPECT_EQ(app::SharedLibrary({"no-such-library.so.1"}).find<int()>("main"), nullptr);
}

} // namespace
} // namespace rt::bench
