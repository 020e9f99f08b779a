// What only the window of ray-tracing-gpu has: its engines, the preview without ray tracing, heat maps by the shader
// clock.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "Common/Image/ImageIo.h"
#include "tests/gui/Desktop.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;
using image::Image;

class GpuWindowTest : public Desktop {
  protected:
    void start(const std::vector<std::string>& arguments = {}) { Desktop::start("ray-tracing-gpu", arguments); }
    void expectCleanEnd() {
        ASSERT_TRUE(isRunning()) << log();
        EXPECT_EQ(quit(), 0) << log(); // 1 where validation had something to say
    }
    fs::path configFolder() const { return folder_ / "config" / "ray-tracing"; }
    // As stored, a while after they have changed.
    nlohmann::json settings() const {
        std::ifstream in(configFolder() / "ray-tracing-gpu.json");
        return nlohmann::json::parse(in, nullptr, false);
    }
    void store(const nlohmann::json& settings) const {
        fs::create_directories(configFolder());
        std::ofstream(configFolder() / "ray-tracing-gpu.json") << settings;
    }
    bool isInHistory(const std::string& engine) const {
        std::ifstream in(configFolder() / "history.jsonl");
        for (std::string line; std::getline(in, line);) {
            const nlohmann::json run = nlohmann::json::parse(line, nullptr, false);
            if (run.is_object() && run.value("engine", "") == engine) return true;
        }
        return false;
    }
    void setRayTracing(bool on) {
        key("p");
        ASSERT_TRUE(eventually([&] {
            const nlohmann::json stored = settings();
            return stored.is_object() && stored.value("ray_tracing", true) == on;
        })) << log();
    }
    // What F12 saves, linear.
    Image picture() {
        const fs::path pictures = folder_ / "pictures";
        Image image;
        const auto isSaved = [&] {
            for (const fs::directory_entry& entry : fs::directory_iterator(pictures)) {
                if (entry.path().extension() == ".exr") image = image::readImage(entry.path());
            }
            return image.width > 0;
        };
        // It may be too early, and then there is a message but no file.
        EXPECT_TRUE(eventually([&] {
            key("F12");
            for (int i = 0; i < 30 && !isSaved(); ++i) pause(100);
            return image.width > 0;
        })) << log();
        pause(500); // the PNG file, too
        for (const fs::directory_entry& entry : fs::directory_iterator(pictures)) fs::remove(entry);
        return image;
    }
};

double luminance(const float* rgb) {
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

// Pearson's correlation of the logarithms of both images' luminance.
double correlation(const Image& a, const Image& b) {
    const std::size_t n = a.data.size() / 3;
    double sumA = 0, sumB = 0, sumAA = 0, sumBB = 0, sumAB = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double x = std::log(luminance(&a.data[3 * i]) + 0.05), y = std::log(luminance(&b.data[3 * i]) + 0.05);
        sumA += x, sumB += y, sumAA += x * x, sumBB += y * y, sumAB += x * y;
    }
    const double count = static_cast<double>(n);
    return (count * sumAB - sumA * sumB) / std::sqrt((count * sumAA - sumA * sumA) * (count * sumBB - sumB * sumB));
}

// Of the pixels that are of strong colour in `render`, the share in which `preview` has the same strongest channel.
double sameHue(const Image& preview, const Image& render) {
    std::size_t coloured = 0, same = 0;
    for (std::size_t i = 0; i < render.data.size(); i += 3) {
        const auto strongest = [&](const Image& image) {
            return std::max_element(&image.data[i], &image.data[i] + 3) - &image.data[i];
        };
        std::array<float, 3> sorted{render.data[i], render.data[i + 1], render.data[i + 2]};
        std::sort(sorted.begin(), sorted.end());
        if (sorted[2] < 2 * sorted[1] || sorted[2] < 0.05f) continue;
        ++coloured;
        same += strongest(preview) == strongest(render);
    }
    EXPECT_GT(coloured, render.data.size() / 3 / 20);
    return static_cast<double>(same) / static_cast<double>(coloured);
}

TEST_F(GpuWindowTest, ThePreviewLooksLikeTheRender) {
    start({"--spp", "64"});
    ASSERT_FALSE(HasFatalFailure());
    setRayTracing(false);
    const Image preview = picture();
    setRayTracing(true);
    ASSERT_TRUE(eventually([&] { return isInHistory("compute") || isInHistory("pipeline") || isInHistory("query"); }))
        << log();
    const Image render = picture();
    ASSERT_EQ(preview.width, 48u);
    ASSERT_EQ(preview.data.size(), render.data.size());
    EXPECT_NE(preview.data, render.data);
    EXPECT_GT(correlation(preview, render), 0.6);
    EXPECT_GT(sameHue(preview, render), 0.9);
    expectCleanEnd();
}

TEST_F(GpuWindowTest, ThePreviewFollowsCameraSceneAndSize) {
    store({{"ray_tracing", false}});
    start();
    ASSERT_FALSE(HasFatalFailure());
    Image last = picture();
    act("keydown w sleep 0.5 keyup w");
    EXPECT_NE(picture().data, last.data);
    last = picture();
    freeze(true);
    key("w"); // down and up between two frames
    freeze(false);
    EXPECT_NE(picture().data, last.data);
    last = picture();
    const std::string before = title();
    key("Next");
    ASSERT_TRUE(eventually([&] { return title() != before; })) << log();
    EXPECT_NE(picture().data, last.data);
    for (const auto& [width, height] : {std::pair{1, 1}, {700, 300}, {1000, 700}}) {
        resize(width, height);
        pause(150);
    }
    key("space"); // nothing rests that could rest
    key("h");
    expectCleanEnd();
    EXPECT_FALSE(fs::exists(configFolder() / "history.jsonl")); // no ray was traced
}

TEST_F(GpuWindowTest, TheEngineIsTheOneThatWasChosen) {
    for (const char* const engine : {"pipeline", "compute"}) {
        store({{"engine", {{"kind", engine}, {"device", "a device of another time"}}}});
        start();
        ASSERT_FALSE(HasFatalFailure());
        EXPECT_TRUE(eventually([&] { return isInHistory(engine); })) << log();
        expectCleanEnd();
        EXPECT_EQ(settings()["engine"]["kind"], engine);
        EXPECT_EQ(settings()["engine"]["device"], "");
    }
}

// Where the row is depends on the interface: each place of that part is tried, with one of the entries below it; again
// and more slowly where the machine is busy.
TEST_F(GpuWindowTest, TheEngineIsExchangedWhileTheWindowIsOpen) {
    store({{"engine", {{"kind", "compute"}}}});
    start();
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(eventually([&] { return isInHistory("compute"); })) << log();
    for (double wait = 0.3; wait < 4 && !isInHistory("pipeline"); wait *= 2) {
        const std::string sleep = " sleep " + std::to_string(wait);
        for (int y = 312; y < 400 && !isInHistory("pipeline"); y += 11) {
            act("mousemove 250 " + std::to_string(y) + " sleep 0.1 click 1" + sleep + " mousemove 250 " +
                std::to_string(y + 44) + " sleep 0.1 click 1" + sleep + " key Escape" + sleep);
        }
    }
    EXPECT_TRUE(eventually([&] { return isInHistory("pipeline"); })) << log();
    expectCleanEnd();
}

TEST_F(GpuWindowTest, HeatMapsAndFramesOfTheirOwn) {
    store({{"render", {{"accumulate", false}, {"samples_per_frame", 0}}}});
    start();
    ASSERT_FALSE(HasFatalFailure());
    for (int i = 0; i < 3; ++i) { // rays, time where the device has a clock, and back
        key("h");
        pause(2500);
        ASSERT_TRUE(isRunning()) << log();
    }
    const Image first = picture();
    EXPECT_GT(*std::max_element(first.data.begin(), first.data.end()), 0);
    // Another frame, once what was asked for before has been saved, too.
    EXPECT_TRUE(eventually([&] { return picture().data != first.data; }));
    expectCleanEnd();
    EXPECT_FALSE(settings()["render"]["accumulate"]);
    EXPECT_EQ(settings()["render"]["samples_per_frame"], 0);
}

} // namespace
} // namespace rt::test
