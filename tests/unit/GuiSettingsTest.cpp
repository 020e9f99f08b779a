#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>

#include <gtest/gtest.h>

#include "Common/App/Interactive/GuiSettings.h"
#include "tests/TempFolder.h"

namespace rt::app {
namespace {

class GuiSettingsTest : public ::testing::Test {
  protected:
    GuiSettings loadText(const std::string& text) const {
        std::filesystem::create_directories(file_.parent_path());
        std::ofstream(file_) << text;
        return loadGuiSettings(file_);
    }
    test::TempFolder folder_;
    std::filesystem::path file_ = folder_ / "sub" / "settings.json"; // saving makes the folder
};

TEST_F(GuiSettingsTest, SurviveTheFile) {
    GuiSettings s;
    s.colorMode = ColorMode::HighContrast;
    s.uiScale = 1.5f;
    s.exposure = -2;
    s.autoExposure = true;
    s.tonemap = Tonemap::Aces;
    s.reloadScenes = false;
    s.sawFirstSteps = true;
    s.recent = {"/a/b.json", "c.obj"};
    s.request.settings.spp = 4000;
    s.request.settings.sampler = SamplerKind::Independent;
    s.request.size.width = 320;
    s.request.size.aspect = 1.5;
    s.request.accumulate = false;
    s.request.timeLimit = 1.5;
    s.request.targetError = 0.01;
    s.engine.policy = Policy::Seq;
    s.rayTracing = false;
    s.showGizmo = false;
    s.gizmo = ObjectTool::Kind::Turn;
    s.localAxes = true;
    s.openPanels = {{"scene", false}, {"view", true}, {"of_a_newer_version", true}};
    s.engine.threads = 3;
    s.engine.kind = GpuEngineKind::Compute;
    s.engine.device = "some GPU";
    s.viewports.resize(4);
    s.viewports[2].request.settings.lightSampling = LightSampling::Bsdf;
    s.viewports[2].exposure = 1.5f;
    s.viewports[3].denoise = false;
    s.viewports[3].engine.threads = 2;
    s.focusedViewport = 1;
    s.splitX = 0.25f;
    s.linkCameras = false;
    saveGuiSettings(file_, s);
    EXPECT_EQ(loadGuiSettings(file_), s);
}

TEST_F(GuiSettingsTest, ThereAreOneTwoOrFourViewports) {
    EXPECT_EQ(loadText("{\"viewports\": [{}, {}], \"focused_viewport\": 1}").viewports.size(), 2u);
    for (const char* text : {"{\"viewports\": [{}, {}, {}]}", "{\"viewports\": [{}]}", "{\"viewports\": 2}"})
        EXPECT_EQ(loadText(text), GuiSettings()) << text;
    const GuiSettings beyond = loadText("{\"viewports\": [{}, {}], \"focused_viewport\": 2, \"split_x\": 2}");
    EXPECT_EQ(beyond.focusedViewport, 0u);
    EXPECT_EQ(beyond.splitX, 0.5f);
}

TEST_F(GuiSettingsTest, NonsenseLeavesDefaults) {
    EXPECT_EQ(loadGuiSettings(folder_ / "missing.json"), GuiSettings());
    for (const char* text : {"", "{", "[]", "12", "null", "{\"ui_scale\": 1e9, \"color_mode\": 7, \"recent\": 3}",
                             "{\"render\": {\"spp\": 0, \"width\": 99999999, \"sampler\": \"dice\"}, \"engine\": 1}",
                             "{\"render\": [], \"window_width\": -5, \"scene\": \"\", \"exposure\": 1e300}"}) {
        EXPECT_EQ(loadText(text), GuiSettings()) << text;
    }
    const GuiSettings half = loadText("{\"ui_scale\": 2, \"tonemap\": []}");
    EXPECT_EQ(half.uiScale, 2);
    EXPECT_EQ(half.tonemap, Tonemap::Neutral);
}

// Scripts that ask for files get those of a program without a window.
TEST_F(GuiSettingsTest, FilesOfTheCommandLineLookAsWithoutAWindow) {
    GuiSettings s;
    s.exposure = 2;
    s.autoExposure = true;
    override(s, *parseOptions("ray-tracing-cpu", {"--no-config", "--window"}, std::cout));
    EXPECT_EQ(s.tonemap, Tonemap::Neutral);
    EXPECT_EQ(s.exposure, 2);
    EXPECT_TRUE(s.autoExposure);
    override(s, *parseOptions("ray-tracing-cpu", {"--no-config", "--window", "-o", "a.png"}, std::cout));
    EXPECT_EQ(s.tonemap, Tonemap::None);
    EXPECT_EQ(s.exposure, 0);
    EXPECT_FALSE(s.autoExposure);
    override(s, *parseOptions("ray-tracing-cpu", {"--no-config", "--tonemap", "aces"}, std::cout));
    EXPECT_EQ(s.tonemap, Tonemap::Aces);
}

TEST_F(GuiSettingsTest, FlagsWinOverWhatWasStored) {
    GuiSettings s;
    s.request.settings.spp = 4000;
    s.request.settings.maxDepth = 9;
    s.scene = "veach-mis";
    const auto options = parseOptions("ray-tracing-cpu", {"--no-config", "--spp", "100", "--height", "50"}, std::cout);
    override(s, *options);
    EXPECT_EQ(s.request.settings.spp, 100u); // the default, but it was said
    EXPECT_EQ(s.request.settings.maxDepth, 9u);
    EXPECT_EQ(s.scene, "veach-mis");
    EXPECT_EQ(s.request.size.height, 50u);
    EXPECT_FALSE(s.request.size.width);
}

TEST_F(GuiSettingsTest, RecentFilesAreFewAndTheLatestComesFirst) {
    GuiSettings s;
    for (int i = 0; i < 20; ++i) s.addRecent(std::to_string(i));
    EXPECT_EQ(s.recent.size(), kMaxRecent);
    s.addRecent("15");
    EXPECT_EQ(s.recent.front(), "15");
    EXPECT_EQ(std::count(s.recent.begin(), s.recent.end(), "15"), 1);
    s.removeRecent("15");
    s.removeRecent("never there");
    EXPECT_EQ(s.recent.size(), kMaxRecent - 1);
    EXPECT_EQ(std::count(s.recent.begin(), s.recent.end(), "15"), 0);
}

} // namespace
} // namespace rt::app
