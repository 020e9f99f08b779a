// `auto`: the engine is chosen by measurement, which is kept, and made again where what was kept is damaged.
#include <algorithm>
#include <atomic>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Paths.h"
#include "Common/Vulkan/Check.h"
#include "RayTracingGPU/EngineChoice.h"
#include "RayTracingGPU/EngineRates.h"
#include "RayTracingGPU/GpuEngine.h"
#include "tests/Environment.h"
#include "tests/TempFolder.h"
#include "tests/cross/Device.h"

namespace rt::test {
namespace {

using app::EngineRate;
using Scene = std::shared_ptr<const scene::CompiledScene>;

std::string contentOf(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void write(const std::filesystem::path& file, const std::string& content) {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << content;
}

std::string fastest(const std::vector<EngineRate>& rates) {
    return std::max_element(rates.begin(), rates.end(),
                            [](const EngineRate& a, const EngineRate& b) { return a.raysPerSecond < b.raysPerSecond; })
        ->engine;
}

// ---- what is kept --------------------------------------------------------------------------------------------------

class EngineRatesTest : public ::testing::Test {
  protected:
    TempFolder folder_;
    const std::filesystem::path file_ = folder_ / "deep" / "rates.json";
    const gpu::EngineRates rates_{file_};
};

TEST_F(EngineRatesTest, AreFoundAgain) {
    EXPECT_TRUE(rates_.find("a").empty());
    rates_.keep("a", {{"compute", 2e9}, {"pipeline", 1e9}});
    rates_.keep("b", {{"compute", 3}, {"query", 0}});
    const std::vector<EngineRate> a = rates_.find("a");
    ASSERT_EQ(a.size(), 2u);
    EXPECT_EQ(fastest(a), "compute");
    EXPECT_EQ(a[0].raysPerSecond + a[1].raysPerSecond, 3e9);
    EXPECT_EQ(rates_.find("b").size(), 2u);
    EXPECT_TRUE(rates_.find("c").empty());
}

TEST_F(EngineRatesTest, WhoeverWasFirstDecides) {
    rates_.keep("a", {{"compute", 2}, {"pipeline", 1}});
    const std::vector<EngineRate> holding = rates_.keep("a", {{"compute", 1}, {"pipeline", 2}});
    EXPECT_EQ(fastest(holding), "compute");
    EXPECT_EQ(fastest(rates_.find("a")), "compute");
}

TEST_F(EngineRatesTest, DamageIsAsIfNothingWereThere) {
    const char* const damaged[] = {
        "",
        "{",
        "[]",
        "null",
        R"({"version": 1})",
        R"({"version": 2, "rates": {"a": {"compute": 1}}})",
        R"({"version": 1, "rates": []})",
        R"({"version": 1, "rates": {"a": []}})",
        R"({"version": 1, "rates": {"a": {"compute": "1"}}})",
        R"({"version": 1, "rates": {"a": {"compute": -1}}})",
        R"({"version": 1, "rates": {"a": {"compute": 1, "quantum": 2}}})",
        R"({"version": 1, "rates": {"a": {"auto": 1}}})",
    };
    for (const char* content : damaged) {
        write(file_, content);
        EXPECT_TRUE(rates_.find("a").empty()) << content;
        rates_.keep("a", {{"pipeline", 1}});
        EXPECT_EQ(rates_.find("a").size(), 1u) << content;
    }
}

TEST_F(EngineRatesTest, APlaceThatCannotBeWrittenIsNoError) {
    write(folder_ / "deep", "a file where a folder should be");
    EXPECT_EQ(rates_.keep("a", {{"compute", 1}}).size(), 1u);
    EXPECT_EQ(gpu::EngineRates("").keep("a", {{"compute", 1}}).size(), 1u);
}

// ---- the choice ----------------------------------------------------------------------------------------------------

class MeasuredEngineTest : public ::testing::Test {
  protected:
    void SetUp() override { setVariable("XDG_CACHE_HOME", folder_.path().string()); }
    void TearDown() override { setVariable("XDG_CACHE_HOME", ""); }

    app::EngineReport reportOfAuto() const {
        const auto engine = gpu::makeGpuEngine(device());
        EXPECT_TRUE(engine->setScene(scene_, nullptr));
        app::RenderSettings settings;
        settings.width = settings.height = 8;
        settings.spp = 1;
        engine->reset(scene_->camera, settings);
        while (!engine->renderSome({}).finished) {
        }
        EXPECT_EQ(engine->film().totalSamples(), 64u);
        return engine->report();
    }

    TempFolder folder_;
    const Scene scene_ = app::compile(app::loadScene("next-week-quads"), true);
};

TEST_F(MeasuredEngineTest, TakesTheFastestAndKeepsToIt) {
    const app::EngineReport first = reportOfAuto();
    EXPECT_FALSE(first.ratesAreOfBefore);
    EXPECT_EQ(first.rates.size(), gpu::enginesOf(device().info()).size());
    for (const EngineRate& rate : first.rates) EXPECT_GT(rate.raysPerSecond, 0) << rate.engine;
    EXPECT_EQ(first.engine, fastest(first.rates));

    const std::string kept = contentOf(gpu::engineRatesFile());
    const app::EngineReport second = reportOfAuto();
    EXPECT_TRUE(second.ratesAreOfBefore);
    EXPECT_EQ(second.engine, first.engine);
    EXPECT_EQ(contentOf(gpu::engineRatesFile()), kept);
}

// Each engine in turn is said to have been the fastest; what was measured decides, not what is likely.
TEST_F(MeasuredEngineTest, FollowsWhatWasMeasured) {
    const std::string key = gpu::ratesKey(device(), *scene_);
    for (const app::GpuEngineKind kind : gpu::enginesOf(device().info())) {
        std::vector<EngineRate> rates;
        for (const app::GpuEngineKind other : gpu::enginesOf(device().info()))
            rates.push_back({app::nameOf(app::kGpuEngines, other), other == kind ? 2.0 : 1.0});
        write(gpu::engineRatesFile(), "");
        gpu::EngineRates(gpu::engineRatesFile()).keep(key, rates);
        EXPECT_EQ(reportOfAuto().engine, app::nameOf(app::kGpuEngines, kind));
    }
    write(gpu::engineRatesFile(), "damaged");
    EXPECT_FALSE(reportOfAuto().ratesAreOfBefore);
    EXPECT_EQ(gpu::EngineRates(gpu::engineRatesFile()).find(key).size(), gpu::enginesOf(device().info()).size());
}

TEST_F(MeasuredEngineTest, CanBeCancelledAndGoOn) {
    const auto engine = gpu::makeGpuEngine(device());
    const std::atomic<bool> cancel{true};
    EXPECT_FALSE(engine->setScene(scene_, &cancel));
    EXPECT_FALSE(std::filesystem::exists(gpu::engineRatesFile()));
    EXPECT_TRUE(engine->setScene(scene_, nullptr));
    EXPECT_FALSE(engine->report().rates.empty());
}

TEST_F(MeasuredEngineTest, AnEngineThatIsNamedIsNotMeasured) {
    const auto engine = gpu::makeGpuEngine(device(), {.engine = app::GpuEngineKind::Compute});
    engine->setScene(scene_, nullptr);
    EXPECT_TRUE(engine->report().rates.empty());
    const auto ranks = gpu::makeGpuEngine(device(), {.measures = false});
    ranks->setScene(scene_, nullptr);
    EXPECT_TRUE(ranks->report().rates.empty());
    EXPECT_EQ(ranks->report().engine, app::nameOf(app::kGpuEngines, gpu::enginesOf(device().info()).back()));
    EXPECT_FALSE(std::filesystem::exists(gpu::engineRatesFile()));
}

// ---- what drivers tell of shaders ----------------------------------------------------------------------------------

TEST(ShaderFiguresTest, AreThereWhereTheDriverTellsThem) {
    const auto figuresOf = [](vulkan::VulkanContext& context) {
        const auto engine =
            gpu::makeGpuEngine(context, {.pipelineCache = false, .engine = app::GpuEngineKind::Compute});
        const Scene scene = app::compile(app::loadScene("next-week-quads"), true);
        engine->setScene(scene, nullptr);
        app::RenderSettings settings;
        settings.width = settings.height = 8;
        engine->reset(scene->camera, settings);
        return engine->report().shaders;
    };
    EXPECT_TRUE(figuresOf(device()).empty()); // they were not asked for
    vulkan::VulkanContext telling({.validation = true, .shaderFigures = true});
    EXPECT_EQ(figuresOf(telling).empty(), !telling.info().hasShaderFigures);
    EXPECT_EQ(telling.validationMessages(), 0u);
}

} // namespace
} // namespace rt::test
