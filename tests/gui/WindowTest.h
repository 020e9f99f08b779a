// A test of either program with its window.
#pragma once
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/gui/Desktop.h"
#include "tests/gui/ScreenText.h"

namespace rt::test {

constexpr std::uint32_t kWindowColor = 0x1b1c20; // of the dark theme

class WindowTest : public Desktop, public testing::WithParamInterface<const char*> {
  protected:
    static constexpr std::chrono::seconds kSeen{90}; // in which all that is drawn is seen, however busy the machine is
    static constexpr std::chrono::milliseconds kAnswered{1500}; // in which a window that has seen a click answers
    static constexpr int kSide = 372;                           // where the panels at the side end

    // By an engine that is named: `auto` would let a software driver compile every engine first.
    void start(std::vector<std::string> arguments = {}) {
        const bool isNamed = std::find(arguments.begin(), arguments.end(), "--engine") != arguments.end();
        if (!isNamed && std::string(GetParam()) == "ray-tracing-gpu")
            arguments.insert(arguments.end(), {"--engine", "compute"});
        Desktop::start(GetParam(), arguments);
    }
    void expectCleanEnd() {
        ASSERT_TRUE(isRunning()) << log();
        EXPECT_EQ(quit(), 0) << log(); // 1 where validation had something to say
    }
    // As slowly as a person does, so that a busy program sees it.
    void click(int x, int y) {
        act("mousemove " + std::to_string(x) + " " + std::to_string(y) +
            " sleep 0.3 mousedown 1 sleep 0.2 mouseup 1 sleep 0.3");
    }
    // Where a text of the interface stands, from the top; at scale 1.
    std::vector<Place> placesOf(const std::string& text, const Place& within = {}) const {
        return findText(screenshot(), text, within);
    }
    bool isShown(const std::string& text, const Place& within = {}) const { return !placesOf(text, within).empty(); }
    bool appears(const std::string& text, const Place& within = {}) {
        return eventually([&] { return isShown(text, within); }, kSeen);
    }
    // Clicks the first place of a text until the condition holds: again where the machine was too busy to see it.
    bool clickText(const std::string& text, const std::function<bool()>& condition) {
        return clickText(text, Place{}, condition);
    }
    bool clickText(const std::string& text, const Place& within, const std::function<bool()>& condition) {
        return eventually(
            [&] {
                if (condition()) return true;
                const std::vector<Place> places = placesOf(text, within);
                if (places.empty()) return false;
                click(places.front().x(), places.front().y());
                pointAtNothing();
                return eventually(condition, kAnswered);
            },
            kSeen);
    }
    // Clicks there until the condition holds, likewise.
    bool clickPlace(int x, int y, const std::function<bool()>& condition) {
        return eventually(
            [&] {
                if (condition()) return true;
                click(x, y);
                return eventually(condition, kAnswered);
            },
            kSeen);
    }
    void pointAtNothing() { act("mousemove 1000 300"); } // the picture, whose pixels have no tooltips
    nlohmann::json settings() const {
        std::ifstream in(folder_ / "config" / "ray-tracing" / (std::string(GetParam()) + ".json"));
        const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
        return json.is_object() ? json : nlohmann::json::object(); // there are none yet
    }
    void store(const nlohmann::json& settings) const {
        std::ofstream(folder_ / "config" / "ray-tracing" / (std::string(GetParam()) + ".json")) << settings;
    }
    // Settings of a window whose panels are folded, but for that of the objects.
    void storeOpenObjects() const {
        nlohmann::json open;
        for (const char* panel : {"scene", "rendering", "camera", "view", "file", "statistics", "settings", "objects"})
            open[panel] = std::string(panel) == "objects";
        std::filesystem::create_directories(folder_ / "config" / "ray-tracing");
        store({{"open_panels", open}, {"saw_first_steps", true}, {"show_comparison", false}});
    }
    // A scene file of this title, good to be opened.
    std::filesystem::path writeScene(const std::string& name, const std::string& title) const {
        std::filesystem::path file = folder_ / name;
        std::ofstream(file) << R"({"version": 1, "title": ")" << title << R"(",
            "camera": {"look_from": [0, 0, 3], "look_at": [0, 0, 0]},
            "background": {"type": "gradient", "bottom": [1, 1, 1], "top": [0.5, 0.7, 1]},
            "materials": {"m": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}},
            "objects": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "m"}]})";
        return file;
    }
    // A scene as of writeScene(), with three balls in a row.
    std::filesystem::path writeThreeBalls(const std::string& name, const std::string& title) const {
        std::filesystem::path file = writeScene(name, title);
        nlohmann::json scene = nlohmann::json::parse(std::ifstream(file));
        nlohmann::json ball = scene["objects"][0];
        ball["radius"] = 0.5;
        scene["objects"].clear();
        for (const double x : {-1.5, 0.0, 1.5}) {
            ball["center"][0] = x;
            scene["objects"].push_back(ball);
        }
        std::ofstream(file) << scene;
        return file;
    }
};

inline const auto kBothPrograms = testing::Values("ray-tracing-cpu", "ray-tracing-gpu");

// One proves what both windows have from Common/Gui. The other one's proof has the prefix Nightly, by which ctest
// leaves it to the nightly tests.
inline const auto kFirstProgram = testing::Values("ray-tracing-cpu");
inline const auto kSecondProgram = testing::Values("ray-tracing-gpu");

inline std::string nameOfProgram(const testing::TestParamInfo<const char*>& info) {
    return std::string(info.param) == "ray-tracing-cpu" ? "Cpu" : "Gpu";
}

} // namespace rt::test
