// Raw and denoised pictures side by side, of an engine whose samples are known.
#include <memory>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Bench/Measurement.h"
#include "Common/Bench/Runner.h"
#include "Common/Render/PictureDenoiser.h"
#include "tests/unit/FakeEngine.h"

namespace rt::bench {
namespace {

using app::FakeEngine;
using app::kGoOn;

TEST(BenchDenoise, AFilteredSnapshotIsWhatTheDenoiserMakesOfBothHalves) {
    FakeEngine engine;
    const auto scene = app::compile(app::loadScene("one-weekend-default"), true, true);
    app::RenderSettings settings;
    settings.width = settings.height = 16;
    const auto run = measure(engine, *scene, settings, {{2, 8}, {}, 1e30, Denoise::On}, 7, kGoOn);
    ASSERT_EQ(run.snapshots.size(), 2u);
    EXPECT_EQ(engine.film().desc().replicates, 2u);
    const auto expected = engine.makeDenoiser()->denoise({app::DenoiseQuality::Final}, kGoOn);
    const Snapshot& last = run.snapshots.back();
    EXPECT_EQ(last.image.data, expected->images.picture.data);
    EXPECT_EQ(last.estimatedRelmse, expected->images.relmse.value);
    EXPECT_GT(last.secondsDenoise, 0);
    EXPECT_GT(last.seconds, last.secondsDenoise); // and the samples
    const auto live = measure(engine, *scene, settings, {{8}, {}, 1e30, Denoise::Live}, 7, kGoOn);
    EXPECT_NE(live.snapshots.at(0).image.data, last.image.data);
    EXPECT_FALSE(live.snapshots.at(0).estimatedRelmse);
}

TEST(BenchDenoise, RawAndDenoisedRowsStandSideBySide) {
    Engines engines({{"multi", [](std::uint32_t) { return std::make_unique<FakeEngine>(); }, ""}});
    ReferenceStore store({}, false);
    const Suite suite = parseSuite(R"({"version": 1, "experiments": [{"name": "e", "scene": "one-weekend-default",
        "width": 16, "height": 16, "denoise": ["off", "on"], "spp": [4, 16], "repeats": 3}]})",
                                   "s.json");
    const Results results = runSuite(suite, engines, store, {[](const std::string&) {}, {}}, kGoOn);
    ASSERT_EQ(results.rows.size(), 4u);
    for (const Row& row : results.rows) {
        const bool isRaw = row.config.denoise == Denoise::Off;
        EXPECT_EQ(bool(row.secondsDenoise), !isRaw);
        EXPECT_EQ(bool(row.estimatedRelmse), !isRaw);
        EXPECT_EQ(bool(row.biasZ), isRaw); // noise that is spread out is not independent from pixel to pixel
        EXPECT_EQ(bool(row.efficiency), isRaw);
        EXPECT_TRUE(row.relmse && row.flip);
    }
    EXPECT_LT(*results.rows[2].relmse, 0.2 * *results.rows[0].relmse); // a flat grey picture
}

} // namespace
} // namespace rt::bench
