// What a user asks of the windows, by the texts on them.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class WishesTest : public WindowTest {
  protected:
    static constexpr Place kPanels{0, 0, kSide, kHeight};
    static constexpr int kControls = 200; // a column of the panels that fields stand in

    void startPlainly(std::vector<std::string> arguments = {}) {
        fs::create_directories(folder_ / "config" / "ray-tracing");
        store({{"saw_first_steps", true}});
        start(std::move(arguments));
    }
    // In the field of this row; again where the machine was too busy to see it.
    bool enter(const std::string& row, const std::string& text, const std::function<bool()>& condition) {
        return eventually(
            [&] {
                if (condition()) return true;
                const std::vector<Place> places = placesOf(row, kPanels);
                if (places.empty()) return false;
                click(kControls, places.front().y());
                key("ctrl+a");
                type(text);
                key("Return");
                pointAtNothing();
                for (int i = 0; i < 20 && !condition(); ++i) pause(100);
                return condition();
            },
            kSeen);
    }
    bool hasSetting(const std::string& value) const {
        const nlohmann::json all = settings().flatten();
        return std::any_of(all.begin(), all.end(), [&](const nlohmann::json& stored) { return stored == value; });
    }
};
INSTANTIATE_TEST_SUITE_P(, WishesTest, kBothPrograms, nameOfProgram);

class SharedWishesTest : public WishesTest {};
INSTANTIATE_TEST_SUITE_P(, SharedWishesTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, SharedWishesTest, kSecondProgram, nameOfProgram);

TEST_P(WishesTest, StopEndsTheRenderAndKeepsWhatThereIs) {
    startPlainly({"--spp", "1000000"});
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(eventually([&] {
        key("F12"); // too early where there is no sample yet
        pause(500);
        return !fs::is_empty(folder_ / "pictures");
    })) << log();
    EXPECT_TRUE(eventually( // its icon
        [&] {
            if (!isShown("stopped", kPanels)) click(176, 16);
            pause(1000);
            return isShown("stopped", kPanels);
        },
        kSeen));
    EXPECT_TRUE(appears("Start")); // over, not paused
    EXPECT_TRUE(fs::exists(folder_ / "config" / "ray-tracing" / "history.jsonl"));
    expectCleanEnd();
}

TEST_P(SharedWishesTest, EnterChoosesInAList) {
    startPlainly();
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_TRUE(eventually(
        [&] { // again where the machine was too busy to see it
            clickText("MIS (power heuristic)", kPanels, [&] { return isShown("Off (BSDF only)"); });
            key("Down");
            pause(500);
            key("Return");
            return eventually([&] { return hasSetting("mis-balance"); }, std::chrono::seconds(3));
        },
        kSeen))
        << settings();
    EXPECT_TRUE(eventually([&] { return !isShown("Off (BSDF only)"); }, kSeen)); // the list is closed
    expectCleanEnd();
}

TEST_P(WishesTest, TheLargestWidthIsNamedAndNothingIsReserved) {
    startPlainly();
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_TRUE(enter("Width", "100000", [&] { return isShown("Width 100000 is more than the most here"); }));
    EXPECT_TRUE(appears("Render at this size", kPanels)); // the largest takes much, too
    EXPECT_LT(residentBytes(), std::uint64_t{2} << 30);
    EXPECT_TRUE(clickText("Keep the size", kPanels, [&] { return !isShown("Render at this size", kPanels); }));
    expectCleanEnd();
}

TEST_P(SharedWishesTest, WhatIsGreySaysWhy) {
    startPlainly();
    ASSERT_FALSE(HasFatalFailure());
    const auto explains = [&](const std::string& text, const std::string& why, const Place& within = {}) {
        return eventually(
            [&] {
                pointAtNothing(); // the last tooltip may hide the text
                pause(200);
                const std::vector<Place> places = placesOf(text, within);
                if (places.empty()) return false;
                act("mousemove " + std::to_string(places.front().x()) + " " + std::to_string(places.front().y()));
                pause(700);
                return isShown("Has no effect now: " + why);
            },
            kSeen);
    };
    EXPECT_TRUE(explains("Error", "it needs a reference"));
    EXPECT_TRUE(explains("Reload on change", "the scene is built in", kPanels));
    key("F3");
    EXPECT_TRUE(explains("Hide", "no run is selected"));
    EXPECT_TRUE(explains("Unhide", "no run is hidden"));
    expectCleanEnd();
}

TEST_P(SharedWishesTest, PickingNothingSaysSo) {
    startPlainly();
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_TRUE(eventually(
        [&] {
            act("mousemove 400 450 sleep 0.2 keydown ctrl keydown shift click 1 keyup shift keyup ctrl");
            pause(1000);
            return isShown("The picture is elsewhere: nothing was picked");
        },
        kSeen));
    expectCleanEnd();
}

TEST_P(SharedWishesTest, TheSceneIsExportedFromThePanelAndNamed) {
    startPlainly();
    ASSERT_FALSE(HasFatalFailure());
    const fs::path file = folder_ / "pictures" / "scene.json";
    const std::string label = "Export the scene";
    // The header, below the progress that says "rendering"; folded it makes room.
    ASSERT_TRUE(clickText("Rendering", {0, 200, kSide, kHeight}, [&] { return !isShown("Samples (SPP)", kPanels); }));
    ASSERT_TRUE(clickText("File", kPanels, [&] { return isShown(label, kPanels); }));
    EXPECT_TRUE(eventually(
        [&] {
            if (!fs::exists(file)) {
                clickText(label, kPanels, [&] { return isShown("Cancel"); });
                key("Return");
                pause(1000);
            }
            return fs::exists(file) && isShown("Saved");
        },
        kSeen))
        << log();
    std::ifstream in(file);
    EXPECT_EQ(nlohmann::json::parse(in, nullptr, false).value("version", 0), 1);
    expectCleanEnd();
}

} // namespace
} // namespace rt::test
