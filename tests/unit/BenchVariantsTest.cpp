// Suites that repeat a race: variants of one view, each for the same time.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Bench/Runner.h"
#include "tests/unit/FakeEngine.h"

namespace rt::bench {
namespace {

using app::FakeEngine;
using app::kGoOn;

// Never gets to the end of a picture by scattering alone.
class EndlessEngine : public FakeEngine {
  public:
    void reset(const scene::CameraDesc& camera, const app::RenderSettings& settings) override {
        FakeEngine::reset(camera, settings);
        isEndless_ = settings.lightSampling == app::LightSampling::Bsdf;
    }
    app::RenderStatus renderSome(const app::Budget& budget) override {
        return isEndless_ ? app::RenderStatus{false, 0, 1} : FakeEngine::renderSome(budget);
    }

  private:
    bool isEndless_ = false;
};

const char* kRace = R"({"version": 1, "experiments": [{"name": "race", "scene": "furnace", "width": 16, "height": 16,
    "camera": {"look_from": [0, 1, 5], "look_at": [0, 0, 0]}, "seconds": 0.02,
    "variants": [{"light_sampling": "mis"}, {"light_sampling": "bsdf"}], "baseline": {"light_sampling": "mis"}}]})";

TEST(BenchVariants, WhoHasNoWholePictureInTimeIsTold) {
    Engines engines({{"multi", [](std::uint32_t) { return std::make_unique<EndlessEngine>(); }, ""}});
    ReferenceStore store({}, false);
    const Results results =
        runSuite(parseSuite(kRace, "race.json"), engines, store, {[](const std::string&) {}, {}}, kGoOn);
    ASSERT_EQ(results.rows.size(), 2u);
    EXPECT_TRUE(results.rows[0].relmse);
    EXPECT_FALSE(results.rows[1].relmse);
    const auto isTold = [](const std::string& notice) {
        return notice.find("furnace, multi, bsdf: no whole picture within 0.02 s") != std::string::npos;
    };
    EXPECT_TRUE(std::any_of(results.notices.begin(), results.notices.end(), isTold));
    EXPECT_FALSE(results.failure);
    EXPECT_EQ(app::poseOf(results.rows[0].config.camera, {}).lookFrom.z, 5);
}

} // namespace
} // namespace rt::bench
