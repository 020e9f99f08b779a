// Both programs with their windows: what a user does, and what a user should not do.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "Common/Image/ImageIo.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

// Of all built-in scenes together.
constexpr const char* kEveryFeature =
    "spheres,moving-spheres,quads,triangles,instances,smooth-normals,lambertian,metal,dielectric,fuzz,emissive,checker,"
    "noise,images,volumes,sky,thin-lens,lights,many-lights,sphere-lights,quad-lights,triangle-lights";

class ControlsTest : public WindowTest {};
INSTANTIATE_TEST_SUITE_P(, ControlsTest, kBothPrograms, nameOfProgram);

class SharedControlsTest : public WindowTest {};
INSTANTIATE_TEST_SUITE_P(, SharedControlsTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, SharedControlsTest, kSecondProgram, nameOfProgram);

// With the GPU by one pipeline that all scenes share, as a software driver takes seconds for each: those that each
// scene has of its own, and the lights, are proved by the comparison of the engines.
TEST_P(SharedControlsTest, ShowsEveryScene) {
    std::vector<std::string> arguments = {"--width", "32", "--spp", "1", "--engine", "multi"};
    if (std::string(GetParam()) == "ray-tracing-gpu") {
        arguments.back() = "pipeline";
        arguments.insert(arguments.end(), {"--light-sampling", "bsdf", "--features", kEveryFeature});
    }
    start(arguments);
    ASSERT_FALSE(HasFatalFailure());
    const std::size_t count = scene::builtinScenes().size();
    for (std::size_t i = 1; i < count; ++i) {
        key("Next");
        const std::string wanted = std::string(scene::builtinScenes()[i].title) + " - " + GetParam();
        ASSERT_TRUE(eventually([&] { return !isRunning() || title() == wanted; }));
        ASSERT_EQ(title(), wanted) << log();
    }
    expectCleanEnd();
}

TEST_P(ControlsTest, SavesThePictureAndRemembersSettings) {
    start();
    ASSERT_FALSE(HasFatalFailure());
    pause(500);
    const auto isSaved = [this] {
        key("F12"); // too early where there is no sample yet
        pause(300);
        for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "pictures"))
            if (entry.path().extension() == ".exr") return true;
        return false;
    };
    ASSERT_TRUE(eventually(isSaved)) << log();
    key("ctrl+equal");
    key("F2");
    key("F3");
    pause(300);
    expectCleanEnd();
    bool isWhole = false;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "pictures"))
        if (entry.path().extension() == ".exr") isWhole = image::readImage(entry.path()).width == 48;
    EXPECT_TRUE(isWhole);
    const nlohmann::json stored = settings();
    EXPECT_EQ(stored["ui_scale"], 1.25);
    EXPECT_EQ(stored["show_comparison"], true);
    EXPECT_EQ(stored["open_panels"]["statistics"], true);
    EXPECT_EQ(stored["render"]["width"], 48);
    EXPECT_TRUE(fs::exists(folder_ / "config" / "ray-tracing" / "history.jsonl"));
}

// Both keys are up again before the program sees any of it.
TEST_P(ControlsTest, ACtrlClickMakesSharpWhatIsThere) {
    start();
    ASSERT_FALSE(HasFatalFailure());
    const auto isSavedWithAnotherFocus = [this] {
        key("F12");
        pause(500);
        for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "pictures")) {
            if (entry.path().extension() != ".exr") continue;
            const std::string note = image::readDescription(entry.path()).value_or("");
            EXPECT_NE(note.find("focus_distance"), std::string::npos);
            if (note.find("focus_distance\\\":10.0") == std::string::npos) return true; // the scene's
        }
        return false;
    };
    key("F12");
    ASSERT_TRUE(eventually([&] { return !fs::is_empty(folder_ / "pictures"); })) << log(); // there are samples
    freeze(true);
    act("keydown ctrl keydown shift mousemove 1000 500 click 1 keyup shift keyup ctrl");
    freeze(false);
    EXPECT_TRUE(eventually(isSavedWithAnotherFocus)) << log();
    expectCleanEnd();
}

TEST_P(SharedControlsTest, AButtonOfTheToolbarHidesThePanels) {
    constexpr int kFromTheRight = 80, kMiddle = 16;
    start();
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_TRUE(settings()["saw_first_steps"].is_null() || settings()["saw_first_steps"] == true);
    pause(500);
    click(kWidth - kFromTheRight, kMiddle);
    EXPECT_TRUE(eventually([&] { return settings()["show_panels"] == false; })) << settings();
    expectCleanEnd();
    EXPECT_EQ(settings()["saw_first_steps"], true); // the hint does not come back
}

// Where the pictures were seen from is told by their descriptions.
TEST_P(SharedControlsTest, ALeftDragOrbits) {
    start();
    ASSERT_FALSE(HasFatalFailure());
    const auto isSavedFrom = [this](std::size_t places) {
        key("F12");
        pause(500);
        std::set<std::string> seen;
        for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "pictures")) {
            if (entry.path().extension() != ".exr") continue;
            const std::string note = image::readDescription(entry.path()).value_or("");
            const std::size_t begin = note.find("look_from");
            if (begin != std::string::npos) seen.insert(note.substr(begin, note.find(']', begin) - begin));
        }
        return seen.size() == places;
    };
    ASSERT_TRUE(eventually([&] { return isSavedFrom(1); })) << log();
    act("mousemove 1000 500 mousedown 1 sleep 0.2 mousemove 1002 501 sleep 0.2 mouseup 1"); // a click, shaken a little
    EXPECT_TRUE(isSavedFrom(1));
    act("mousemove 1000 500 mousedown 1 sleep 0.2 mousemove 1040 500 sleep 0.2 mousemove 1080 500 sleep 0.2 mouseup 1");
    EXPECT_TRUE(eventually([&] { return isSavedFrom(2) || isSavedFrom(3); })) << log();
    // Beside a pinned picture it moves the line between the two, and orbits with Alt.
    const bool isTwo = isSavedFrom(2);
    key("b");
    pause(300);
    const std::string drag = "mousedown 1 sleep 0.2 mousemove 900 500 sleep 0.2 mousemove 860 500 sleep 0.2 mouseup 1";
    act("mousemove 940 500 " + drag);
    EXPECT_TRUE(isSavedFrom(isTwo ? 2 : 3));
    act("mousemove 940 500 keydown alt " + drag + " keyup alt");
    EXPECT_TRUE(eventually([&] { return isSavedFrom(isTwo ? 3 : 4) || isSavedFrom(isTwo ? 4 : 5); })) << log();
    expectCleanEnd();
}

// From the picture: the first header is folded.
TEST_P(SharedControlsTest, TheKeyboardReachesThePanels) {
    start();
    ASSERT_FALSE(HasFatalFailure());
    act("mousemove 1000 700 click 1");
    for (const char* name : {"Tab", "Down", "space"}) {
        pause(700);
        key(name);
    }
    EXPECT_TRUE(eventually([&] { return settings()["open_panels"]["scene"] == false; })) << settings();
    expectCleanEnd();
}

// Clicks into every row of the panels, and then where the second entry is of the menu that this may have opened:
// between two rows where it has not. What has changed is told by the settings that remain. A machine that is too busy
// for a frame between two clicks gets more time.
TEST_P(SharedControlsTest, EveryControlCanBeUsed) {
    constexpr int kColumn = 200, kRow = 29, kSecondEntry = 43, kRenderingHeader = 294, kBottom = 830;
    constexpr std::size_t kEnough = 4; // settings that have changed; menus are left as they were as often as not
    std::set<std::string> changed;
    const auto clickAt = [](int y, double pace) {
        const std::string wait = " sleep " + std::to_string(pace) + " ";
        return "mousemove " + std::to_string(kColumn) + " " + std::to_string(y) + wait + "mousedown 1" + wait +
               "mouseup 1" + wait;
    };
    const auto clickRows = [&](int from, int to, double pace) {
        std::string clicks;
        for (int y = from; y < to; y += kRow) clicks += clickAt(y, pace) + clickAt(y + kSecondEntry, pace);
        act(clicks);
    };
    const auto session = [&](const std::function<void()>& clicks) {
        nlohmann::json stored = settings();
        stored.erase("open_panels"); // they are folded as at first
        store(stored);
        start({"--scene", "cornell-box-lights"});
        ASSERT_FALSE(HasFatalFailure());
        const nlohmann::json before = settings().flatten();
        clicks();
        act("mousemove " + std::to_string(kWidth - 100) + " 200");
        expectCleanEnd();
        const nlohmann::json after = settings().flatten();
        for (const auto& [key, value] : after.items())
            if ((!before.contains(key) || before[key] != value) && key.find("/open_panels") != 0) changed.insert(key);
    };
    start(); // so that there are settings
    ASSERT_FALSE(HasFatalFailure());
    expectCleanEnd();
    for (double pace = 0.04; pace < 0.4 && changed.size() < kEnough && !HasFailure(); pace *= 3) {
        session([&] { clickRows(kRenderingHeader + kRow, kBottom, pace); });
        session([&] { // with the panel Rendering closed, those of camera and view come to light
            const int camera = kRenderingHeader + kRow, view = camera + kRow;
            act(clickAt(kRenderingHeader, pace) + clickAt(camera, pace));
            clickRows(view, kBottom, pace);
            act(clickAt(camera, pace) + clickAt(view, pace));
            clickRows(view + kRow, kBottom, pace);
        });
    }
    EXPECT_GE(changed.size(), kEnough);
}

class NightlyControlsTest : public ControlsTest {
  protected:
    static int below(std::mt19937& random, int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); }
    static std::string place(std::mt19937& random) {
        const int x = below(random, kWidth), y = below(random, kHeight);
        return std::to_string(x) + " " + std::to_string(y);
    }
    void actAtRandom(std::mt19937& random);
    std::uint64_t bytesAtRest();
};
INSTANTIATE_TEST_SUITE_P(, NightlyControlsTest, kBothPrograms, nameOfProgram);

// One of the actions that nobody would think of.
void NightlyControlsTest::actAtRandom(std::mt19937& random) {
    static constexpr const char* kKeys[] = {
        "F1",          "F2", "F3",   "F4",        "space",      "1",      "2",         "5",      "r",
        "f",           "h",  "b",    "F12",       "Tab",        "Return", "Escape",    "Down",   "Right",
        "ctrl+r",      "9",  "Next", "ctrl+plus", "ctrl+minus", "p",      "shift+Tab", "ctrl+o", "ctrl+shift+c",
        "ctrl+shift+v"};
    const std::string button = std::to_string(1 + below(random, 3));
    switch (below(random, 7)) {
        case 0:
        case 1:
            return act("mousemove " + place(random) + " click " + button);
        case 2: {
            const std::string from = place(random), to = place(random);
            return act("mousemove " + from + " mousedown " + button + " mousemove " + to + " mouseup " + button);
        }
        case 3: {
            const std::string wheel = std::to_string(4 + below(random, 2));
            return act("mousemove " + place(random) + " click " + wheel);
        }
        case 4:
            return type(std::to_string(below(random, 100)) + "-e.x");
        case 5: {
            const std::string held(1, "wasdqe"[below(random, 6)]);
            return act("keydown " + held + " sleep 0.05 keyup " + held);
        }
        default:
            return key(kKeys[static_cast<std::size_t>(below(random, static_cast<int>(std::size(kKeys))))]);
    }
}

// What it takes where it shows the same each time and is at rest: while it renders, or a software driver compiles for
// it, memory goes up and down by hundreds of megabytes.
std::uint64_t NightlyControlsTest::bytesAtRest() {
    key("Escape");
    act("mousemove 1 1");
    resize(1100, 800);
    drop({(folder_ / "rest.json").string()});
    constexpr int kLooks = 60, kMaxBusy = kLooks / 10; // what blinks is drawn at rest, too
    const auto isAtRest = [this] {
        int busy = 0;
        for (int look = 0; look < kLooks && busy <= kMaxBusy; ++look) {
            pause(50);
            busy += isBusy();
        }
        return busy <= kMaxBusy;
    };
    EXPECT_TRUE(eventually([&] { return !isRunning() || isAtRest(); }, std::chrono::minutes(10))) << "never at rest";
    return residentBytes();
}

// What 2,000 actions leave behind: a program that runs, answers and ends as it should, with nothing that validation
// has to say. Each round does the same as the one before. In the first half the program meets what is made once
// (scenes, thumbnails, fonts) and a software driver compiles what it keeps; what the second half keeps beyond that is
// lost. In eight rounds the memory of ray-tracing-gpu stops growing after the fifth and moves by 2.5 % from one round
// to the next, hence the bound: of 160 MB it is 8 kB an action.
TEST_P(NightlyControlsTest, SurvivesRandomActions) {
    constexpr int kRounds = 4, kActions = 500, kUntilResize = 50;
    constexpr double kMaxGrowth = 1.05;
    writeScene("rest.json", "At rest");
    start();
    ASSERT_FALSE(HasFatalFailure());
    std::vector<std::uint64_t> bytes; // after each round
    for (int round = 0; round < kRounds; ++round) {
        std::mt19937 random(20260101);
        for (int i = 0; i < kActions; ++i) {
            actAtRandom(random);
            if (i % kUntilResize == kUntilResize - 1) {
                const int width = 1 + below(random, kWidth);
                resize(width, 1 + below(random, kHeight));
                key("Escape");
                resize(1100, 800);
            }
            ASSERT_TRUE(isRunning()) << "after action " << i << " of round " << round << "\n" << log();
        }
        bytes.push_back(bytesAtRest());
    }
    const std::uint64_t half = bytes[kRounds / 2 - 1];
    EXPECT_LT(static_cast<double>(bytes.back()), kMaxGrowth * static_cast<double>(half))
        << testing::PrintToString(bytes);
    act("mousemove 1000 700");
    expectCleanEnd();
}

} // namespace
} // namespace rt::test
