// A race in a window: started, looked at, saved.
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "Common/Bench/Suite.h"
#include "Common/Image/ImageIo.h"
#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class RaceTest : public WindowTest {
  protected:
    void startWithPanel(double seconds) {
        fs::create_directories(folder_ / "config" / "ray-tracing");
        store({{"saw_first_steps", true}, {"show_race", true}, {"race_seconds", seconds}});
        scene_ = writeScene("ball.json", "Ball");
        start({"--scene", scene_.string(), "--width", "64", "--spp", "4"});
    }
    fs::path saved(const std::string& name) const { return folder_ / "pictures" / name; }
    bool save(const std::string& button, const std::string& name) {
        return clickText(button, kPanel, [&] { return fs::exists(saved(name)); });
    }
    // The saved table has points of each of these racers.
    void expectCurvesOf(std::initializer_list<const char*> racers) const {
        for (const std::string racer : racers) {
            std::ifstream table(saved("race.csv"));
            int points = 0;
            for (std::string line; std::getline(table, line);) points += line.find("," + racer + ",") != line.npos;
            EXPECT_GT(points, 0) << racer;
        }
    }
    static constexpr Place kPanel{kSide, kHeight / 2, 1 << 20, 1 << 20};
    fs::path scene_;
};
INSTANTIATE_TEST_SUITE_P(, RaceTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, RaceTest, kSecondProgram, nameOfProgram);

TEST_P(RaceTest, TwoEstimatorsRaceAndAllIsSaved) {
    startWithPanel(0.5);
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(appears("Start race", kPanel)) << log();
    const auto isOver = [this] { return isShown("race over", {0, 0, kSide, kHeight}); };
    ASSERT_TRUE(clickText("Start race", kPanel, isOver)) << log();
    ASSERT_TRUE(save("Save table", "race.csv")) << log();
    expectCurvesOf({"mis", "bsdf"});
    ASSERT_TRUE(save("Save picture", "race.png")) << log();
    EXPECT_GT(image::readImage(saved("race.png")).width, 200u);
    ASSERT_TRUE(save("Save run file", "race.json")) << log();
    const bench::Suite suite = bench::loadSuite(saved("race.json").string());
    const std::vector<bench::Config> configs = bench::combinations(suite.experiments.front(), 4);
    ASSERT_EQ(configs.size(), 2u);
    EXPECT_EQ(configs[0].scene, scene_.string());
    EXPECT_EQ(configs[0].settings.width, 64u);
    EXPECT_EQ(configs[0].settings.lightSampling, app::LightSampling::Mis);
    EXPECT_EQ(configs[1].settings.lightSampling, app::LightSampling::Bsdf);
    key("F5"); // the film comes back
    EXPECT_TRUE(eventually([this] { return !isShown("race over", {0, 0, kSide, kHeight}); }, kSeen));
    expectCleanEnd();
}

// The real one, on whatever device there is.
TEST_P(RaceTest, TheOtherProgramRacesToo) {
    const bool isCpu = std::string(GetParam()) == "ray-tracing-cpu";
    const std::string own = isCpu ? "CPU" : "GPU", other = isCpu ? "GPU" : "CPU";
    startWithPanel(3); // a software device takes its first samples of all pixels late where others are at work, too
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(appears("Start race", kPanel)) << log();
    ASSERT_TRUE(clickText(own, kPanel, [&] { return isShown(other, kPanel); })) << log();
    const auto isOver = [this] { return isShown("race over", {0, 0, kSide, kHeight}); };
    // The other program compiles its kernels first.
    ASSERT_TRUE(eventually([&] { return clickText("Start race", kPanel, isOver); })) << log();
    ASSERT_TRUE(save("Save table", "race.csv")) << log();
    expectCurvesOf({"cpu", "gpu"});
    expectCleanEnd();
}

} // namespace
} // namespace rt::test
