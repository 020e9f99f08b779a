// What parts of the work cost: that each part which is left out is left out. What it costs, no test asserts.
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Bench/Parts.h"
#include "Common/Core/Error.h"
#include "Common/Shared/Base/Features.h"
#include "RayTracingCPU/CpuEngine.h"
#include "tests/unit/FakeEngine.h"

namespace rt::bench {
namespace {

using app::kGoOn;

Engines oneThread() {
    return Engines({{"single",
                     [](std::uint32_t) {
                         cpu::CpuEngineOptions options;
                         options.policy = cpu::Policy::Seq;
                         return cpu::makeCpuEngine(options);
                     },
                     ""}});
}

double perSample(std::uint64_t count, const PartRow& row) {
    return static_cast<double>(count) / static_cast<double>(row.samples);
}

TEST(BenchParts, EachIsLeftOutInTurn) {
    Engines engines = oneThread();
    const PartsRequest request{.engine = "single", .width = 16, .seconds = 0.05};
    const std::vector<PartRow> rows = measureParts(engines, request, kGoOn);
    ASSERT_EQ(rows.size(), parts().size());
    std::map<std::string, PartRow> by;
    for (const PartRow& row : rows) {
        EXPECT_GT(row.samples, 0u) << row.part;
        EXPECT_GT(row.seconds, 0) << row.part;
        by[row.part] = row;
    }
    const PartRow& whole = rows.front();
    EXPECT_GT(perSample(whole.rays.shadow, whole), 1);
    EXPECT_EQ(by.at("light sampling (BSDF alone)").rays.shadow, 0u);
    EXPECT_GT(whole.rays.reuse, 0u);
    EXPECT_EQ(by.at("path reuse").rays.reuse, 0u);
    EXPECT_GT(perSample(by.at("roulette").rays.scattered, by.at("roulette")),
              1.3 * perSample(whole.rays.scattered, whole)); // 4.4 rays instead of 2.1
    const PartRow& camera = by.at("all but camera rays");
    EXPECT_EQ(camera.rays.all() - camera.rays.camera, 0u);
    EXPECT_EQ(camera.rays.camera, camera.samples);
    EXPECT_TRUE(shared::has(whole.features, shared::kFeatureDielectric));
    EXPECT_FALSE(
        shared::has(by.at("materials (all diffuse)").features, shared::kFeatureDielectric | shared::kFeatureMetal));
    EXPECT_EQ(by.at("the exact mask (all features)").features, shared::kFeatureAll);
}

TEST(BenchParts, DescribesCostsAndShaders) {
    PartRow whole{"nothing", 2.0, 1000, {1000, 2000, 1000}, "k", {}, {{"main", "Register Count", 128}}};
    PartRow half{
        "a part", 1.0, 1000, {1000, 1000, 0}, "k", {}, {{"main", "Register Count", 80}, {"main", "Spills", 3}}};
    const Document document = describeParts({}, std::vector{whole, half});
    ASSERT_EQ(document.size(), 3u);
    const Table& costs = std::get<Table>(document[1]);
    EXPECT_EQ(costs.rows[0][2], "4");
    EXPECT_EQ(costs.rows[1][6], "50.0 %"); // 1 ms a sample instead of 2
    EXPECT_EQ(costs.rows[1][7], "0.0 %");  // 0.5 ms a ray in both
    const Table& shaders = std::get<Table>(document[2]);
    EXPECT_EQ(shaders.header, (std::vector<std::string>{"left out", "shader", "Register Count", "Spills"}));
    EXPECT_EQ(shaders.rows[1], (std::vector<std::string>{"a part", "main", "80", "3"}));
}

TEST(BenchParts, AnEngineThatIsMissingIsAnError) {
    Engines engines = oneThread();
    EXPECT_THROW(measureParts(engines, {.engine = "compute"}, kGoOn), RenderError);
}

} // namespace
} // namespace rt::bench
