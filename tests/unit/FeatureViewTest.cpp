// Albedo and normal as a window shows them against the files of --aov.
#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "Common/Image/ImageIo.h"
#include "Common/Shared/Tonemap.h"
#include "RayTracingCPU/CpuEngine.h"
#include "tests/unit/InteractiveFixture.h"

namespace rt::app {
namespace {

class FeatureViewTest : public InteractiveFixture {
  protected:
    static InteractiveSession::Setup cpuSetup() {
        InteractiveSession::Setup with = setup(16);
        with.makeEngine = [](const EngineChoice&) { return cpu::makeCpuEngine({}); };
        return with;
    }
    // What the window shows, and what the file holds.
    std::pair<image::Image, image::Image> viewAndFile(ViewMode mode, Aov aov, const std::string& name) {
        InteractiveSession session(cpuSetup());
        EXPECT_TRUE(reaches(session, isFinished));
        session.view({mode, 1, false});
        EXPECT_TRUE(reaches(session, [](const SessionState& s) { return s.picture.isDisplay; }));
        image::Image view = *session.state().picture.image;
        session.save({.files = {(folder_ / "a.exr").string()}, .aovs = {aov}});
        EXPECT_TRUE(reaches(session, [](const SessionState& s) { return s.messageSerial > 0; }));
        return {std::move(view), image::readImage(folder_ / ("a." + name + ".exr"))};
    }
};

TEST_F(FeatureViewTest, AlbedoIsThatOfTheFile) {
    const auto [view, file] = viewAndFile(ViewMode::Albedo, Aov::Albedo, "albedo");
    ASSERT_EQ(view.data.size(), file.data.size());
    for (std::size_t i = 0; i < view.data.size(); ++i) ASSERT_NEAR(view.data[i], file.data[i], 1e-6f) << i;
    // Means of sixteen samples at edges: more values than the scene has colours.
    EXPECT_GT(std::set<float>(view.data.begin(), view.data.end()).size(), 20u);
}

TEST_F(FeatureViewTest, NormalsAreThoseOfTheFileAsColours) {
    const auto [view, file] = viewAndFile(ViewMode::Normal, Aov::Normal, "normal");
    ASSERT_EQ(view.data.size(), file.data.size());
    for (std::size_t i = 0; i < view.data.size(); ++i)
        ASSERT_NEAR(shared::srgbEncode(view.data[i]), std::clamp(0.5f * file.data[i] + 0.5f, 0.0f, 1.0f), 1e-3f) << i;
}

} // namespace
} // namespace rt::app
