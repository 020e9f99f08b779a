// How the other program is told to do the same work.
#include <fstream>
#include <iostream>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>

#include "Common/App/Interactive/OtherEngine.h"
#include "Common/App/Options/Options.h"
#include "Common/App/Platform.h"
#include "Common/Core/Error.h"
#include "Common/Core/Paths.h"
#include "tests/TempFolder.h"

namespace rt::app {
namespace {

OtherJob job() {
    OtherJob job;
    job.program = "ray-tracing-gpu";
    job.scene = {"quads", false, "", "assets"};
    job.compiled = compile(SceneRequest{"cornell-box-lights"});
    job.camera.lookFrom = {1.0 / 3, 2, -7};
    job.camera.lookAt = {0, 1e-3, 0};
    job.camera.defocusAngle = 0.25;
    RenderSettings& s = job.settings;
    s.width = 31;
    s.height = 17;
    s.spp = 12;
    s.maxDepth = 7;
    s.seed = 9;
    s.replicates = 4;
    s.lightSampling = LightSampling::MisBalance;
    s.lightSelection = LightSelection::Power;
    s.sphereLight = ShapeSampling::Area;
    s.quadLight = ShapeSampling::SolidAngle;
    s.triangleLight = ShapeSampling::Projected;
    s.sampler = SamplerKind::Independent;
    s.russianRoulette = false;
    s.pathReuse = PathReuse::Off;
    return job;
}

TEST(OtherEngine, ItsFlagsAskForTheSameWork) {
    for (const char* program : {"ray-tracing-cpu", "ray-tracing-gpu"}) {
        const Options options = parseOptions(program, argumentsFor(job(), "p.pfm", "s.json"), std::cout).value();
        RenderSettings settings = options.settings;
        settings.width = options.size.width.value();
        settings.height = options.size.height.value();
        EXPECT_EQ(settings, job().settings);
        EXPECT_EQ(poseOf(options.camera, {}), job().camera);
        EXPECT_EQ(options.scene, "quads");
        EXPECT_EQ(options.assetsBelow, "assets");
        EXPECT_FALSE(options.oneSidedLights);
        EXPECT_FALSE(options.window);
        EXPECT_EQ(options.outputs, std::vector<std::string>{"p.pfm"});
        EXPECT_EQ(options.stats, "s.json");
    }
}

TEST(OtherEngine, ReadsProgressFromWholeLines) {
    EXPECT_EQ(progressIn(""), 0u);
    EXPECT_EQ(progressIn("warning: 12/14 of something\n"), 0u);
    EXPECT_EQ(progressIn("3/100 spp  3%  1.00 M samples/s  0:07 left\n"), 3u);
    EXPECT_EQ(progressIn("3/100 spp  3%\n37/100 spp  37%\n4"), 37u);
    EXPECT_EQ(progressIn("3/100 spp  3%\n100 spp in 1.00 s  1.00 M samples/s  done\n"), 3u);
}

TEST(OtherEngine, AProgramThatIsMissingIsOneLine) {
    const test::TempFolder folder;
    RunHistory history({});
    OtherEngine other(history, {});
    other.folder = folder.path();
    other.start(job());
    while (other.isRunning()) std::this_thread::yield();
    EXPECT_EQ(other.state().phase, OtherState::Phase::Failed);
    EXPECT_NE(other.state().error.find("ray-tracing-gpu"), std::string::npos) << other.state().error;
    EXPECT_EQ(other.state().error.find('\n'), std::string::npos);
    EXPECT_TRUE(history.records().empty());
}

// This program stands in for another.
TEST(ChildProcess, TellsItsExitCodeAndWritesToItsFile) {
    const test::TempFolder folder;
    const auto codeOf = [](ChildProcess& child) {
        std::optional<int> code;
        while (!(code = child.exitCode())) std::this_thread::yield();
        return *code;
    };
    const std::vector<std::string> list = {"--gtest_list_tests", "--gtest_filter=ChildProcess.*"};
    ChildProcess good(executablePath(), list, folder / "log");
    EXPECT_EQ(codeOf(good), 0);
    EXPECT_EQ(good.exitCode(), 0); // also the second time
    std::ifstream in(folder / "log");
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    EXPECT_NE(text.find("TellsItsExitCode"), std::string::npos) << text;
    EXPECT_THROW(ChildProcess(folder / "missing", {}, folder / "log2"), RenderError);
}

TEST(ChildProcess, IsEndedAtOnce) {
    const test::TempFolder folder;
    const std::vector<std::string> forever = {"--gtest_filter=none", "--gtest_repeat=-1", "--gtest_brief=1"};
    ChildProcess child(executablePath(), forever, folder / "log");
    EXPECT_FALSE(child.exitCode());
    child.end();
    EXPECT_TRUE(child.exitCode().has_value());
    EXPECT_NE(child.exitCode(), 0);
}

} // namespace
} // namespace rt::app
