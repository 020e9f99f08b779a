// What light sampling does at a point of the picture: picked, dragged and saved by way of a window.
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class SamplerTest : public WindowTest {
  protected:
    static constexpr int kPointX = 826, kPointY = 560; // of the screen: the floor, below the picture's middle
    static constexpr Place kSidePlace{0, 0, kSide, kHeight};

    // Of the panels only the one of the sampler is folded out.
    void startWithPanel() {
        nlohmann::json open;
        for (const char* panel :
             {"scene", "rendering", "camera", "view", "file", "statistics", "settings", "objects", "sampler"})
            open[panel] = std::string(panel) == "sampler";
        fs::create_directories(folder_ / "config" / "ray-tracing");
        store({{"open_panels", open},
               {"saw_first_steps", true},
               {"show_comparison", false},
               {"save_folder", folder_.string()}});
        start({"--scene", "cornell-box-lights", "--width", "64", "--spp", "4"});
    }
    std::vector<fs::path> savedFiles() const {
        std::vector<fs::path> files;
        for (const auto& entry : fs::directory_iterator(folder_))
            if (entry.path().extension() == ".json" && entry.path().string().find("-probe-") != std::string::npos)
                files.push_back(entry.path());
        return files;
    }
    bool save(std::size_t files) {
        return clickText("Save PNG and JSON", kSidePlace, [&] { return savedFiles().size() == files; });
    }
};
INSTANTIATE_TEST_SUITE_P(, SamplerTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, SamplerTest, kSecondProgram, nameOfProgram);

TEST_P(SamplerTest, APointIsPickedDraggedAndSaved) {
    startWithPanel();
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(clickText("Pick a point", kSidePlace, [this] { return isShown("Click in the picture", kSidePlace); }))
        << log();
    click(kPointX, kPointY);
    EXPECT_TRUE(appears("Strategy", kSidePlace)) << log();
    EXPECT_TRUE(appears("degrees: p =", kSidePlace)) << log(); // of chi-square, as soon as there is one
    ASSERT_TRUE(save(1)) << log();
    const fs::path first = savedFiles().front();
    nlohmann::json figures;
    ASSERT_TRUE(eventually([&] {
        std::ifstream in(first);
        figures = nlohmann::json::parse(in, nullptr, false);
        return figures.is_object();
    }));
    EXPECT_EQ(figures["scene"], "cornell-box-lights");
    EXPECT_EQ(figures["strategy"], "lights");
    EXPECT_GT(figures["chi_square"]["p"], 1e-4) << figures;
    EXPECT_NEAR(figures["integral"].get<double>() + figures["dropped"].get<double>() / 4096, 1, 0.05) << figures;
    EXPECT_TRUE(fs::exists(fs::path(first).replace_extension(".png")));

    // The mark is dragged; the camera, which else orbits, stays.
    const auto points = std::array{std::to_string(kPointX) + " " + std::to_string(kPointY),
                                   std::to_string(kPointX + 60) + " " + std::to_string(kPointY)};
    act("mousemove " + points[0] + " sleep 0.5 mousedown 1 sleep 0.5 mousemove_relative 20 0 sleep 0.3 mousemove " +
        points[1] + " sleep 0.5 mouseup 1 sleep 0.5");
    pointAtNothing();
    ASSERT_TRUE(save(2)) << log();
    const std::vector<fs::path> files = savedFiles();
    const fs::path second = files.front() == first ? files.back() : files.front();
    ASSERT_TRUE(eventually([&] {
        std::ifstream in(second);
        const nlohmann::json moved = nlohmann::json::parse(in, nullptr, false);
        return moved.is_object() && moved["pixel"][0] > figures["pixel"][0] && moved["pixel"][1] == figures["pixel"][1];
    }));
    expectCleanEnd();
}

} // namespace
} // namespace rt::test
