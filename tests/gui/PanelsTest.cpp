// The panels at the side of both windows, and what there is to see of them.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Image/ImageIo.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class PanelsTest : public WindowTest {
  protected:
    // Of those at the side, only this one is folded out: its first row stands below the headers.
    void foldOutOnly(const std::string& wanted) const {
        nlohmann::json open;
        for (const char* panel : {"scene", "rendering", "camera", "view", "statistics"}) open[panel] = panel == wanted;
        fs::create_directories(folder_ / "config" / "ray-tracing");
        store({{"open_panels", open}, {"saw_first_steps", true}});
    }
    // That of this name in the pictures' folder.
    bool isSaved(const std::string& part) const {
        for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "pictures"))
            if (entry.path().filename().string().find(part) != std::string::npos) return true;
        return false;
    }
    bool isGpu() const { return std::string(GetParam()) == "ray-tracing-gpu"; }
    static constexpr int kRow = 29;
    int samplesRow() const { return isGpu() ? 410 : 381; }
    // A dot at the upper right of the row's label.
    bool areSamplesMarked() const {
        const Screenshot shot = screenshot();
        return shot.at(110, samplesRow() - 4) != shot.at(130, samplesRow() - 4);
    }
};
INSTANTIATE_TEST_SUITE_P(, PanelsTest, kBothPrograms, nameOfProgram);

class SharedPanelsTest : public PanelsTest {};
INSTANTIATE_TEST_SUITE_P(, SharedPanelsTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, SharedPanelsTest, kSecondProgram, nameOfProgram);

// One thread cannot be divided, rasterised pictures have no samples: their rows stay, and so do those below.
TEST_P(PanelsTest, ChangedSettingsAreMarkedAndRestoredAndDisabledRowsStayInPlace) {
    start({"--width", "32", "--spp", "7", "--engine", isGpu() ? "compute" : "single"});
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_TRUE(eventually([&] { return areSamplesMarked(); }));
    if (isGpu()) {
        key("p");
        EXPECT_TRUE(eventually([&] { return settings()["ray_tracing"] == false; })) << settings();
        EXPECT_TRUE(areSamplesMarked());
        click(185, samplesRow() + 2 * kRow); // +100 spp
        EXPECT_EQ(settings()["render"]["spp"], 7);
    }
    click(75, samplesRow() + 253 + 3 * kRow); // Restore defaults
    EXPECT_TRUE(eventually([&] { return settings()["render"]["spp"] == 100; })) << settings();
    EXPECT_TRUE(eventually([&] { return !areSamplesMarked(); }));
    EXPECT_EQ(settings()["render"]["width"], nlohmann::json()) << settings();
    expectCleanEnd();
}

TEST_P(SharedPanelsTest, TheSceneBrowserFindsByName) {
    start({"--width", "32", "--spp", "1"});
    ASSERT_FALSE(HasFatalFailure());
    const scene::BuiltinScene& wanted = scene::builtinScenes().back();
    const auto open = [this] {
        click(200, 181); // the scene's button
        EXPECT_TRUE(eventually([this] { return screenshot().at(226, 768) == kWindowColor; }));
        pause(1000); // the field has the keyboard
    };
    open();
    type(std::string(wanted.id));
    pause(300);
    key("Return");
    EXPECT_TRUE(eventually([&] { return title().find(wanted.title) == 0; })) << title() << log();
    open();
    type("no such scene");
    pause(1000);   // all of it
    key("Return"); // nothing to open
    pause(500);
    EXPECT_EQ(title().find(wanted.title), 0u) << title();
    expectCleanEnd();
}

// The film goes on: it has all of them.
TEST_P(SharedPanelsTest, MoreSamplesAndBudgetsAreAtHand) {
    start({"--width", "32", "--spp", "4", "--engine", isGpu() ? "compute" : "multi"});
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_TRUE(eventually([&] {
        key("F12");
        pause(500);
        return isSaved("-4spp-denoised.exr");
    })) << log();
    click(185, samplesRow() + 2 * kRow); // +100 spp
    EXPECT_TRUE(eventually([&] { return settings()["render"]["spp"] == 104; })) << settings();
    EXPECT_TRUE(eventually([&] {
        key("F12");
        pause(500);
        return isSaved("-104spp-denoised.exr");
    })) << log();
    const auto enter = [&](int row, const std::string& number) {
        click(247, samplesRow() + row * kRow);
        pause(300);
        type(number);
        pause(300);
        key("Return");
        pause(300);
    };
    enter(3, "7.5");
    EXPECT_TRUE(eventually([&] { return settings()["render"]["time_limit"] == 7.5; })) << settings();
    enter(4, "0.25");
    EXPECT_TRUE(eventually([&] { return settings()["render"]["target_error"] == 0.25; })) << settings();
    enter(3, "0"); // none
    EXPECT_TRUE(eventually([&] { return settings()["render"]["time_limit"].is_null(); })) << settings();
    expectCleanEnd();
}

// 9000 x 9000 pixels: nothing is reserved for them, and the next size that is typed is rendered.
TEST_P(SharedPanelsTest, AnImageOfMuchMemoryIsAskedFor) {
    start({"--width", "48", "--spp", "1", "--engine", isGpu() ? "compute" : "multi"});
    ASSERT_FALSE(HasFatalFailure());
    const int widthRow = samplesRow() + 7 * kRow;
    const auto enter = [&](const std::string& number) {
        click(220, widthRow);
        pause(500);
        type(number);
        pause(300);
        key("Return");
        pause(3000); // settings are kept every other second
    };
    enter("9000");
    EXPECT_NE(settings()["render"]["width"], 9000) << settings();
    EXPECT_LT(residentBytes(), std::uint64_t{2} << 30);
    click(210, widthRow + 79); // Keep the size
    enter("64");
    EXPECT_TRUE(eventually([&] { return settings()["render"]["width"] == 64; })) << settings();
    expectCleanEnd();
}

TEST_P(SharedPanelsTest, AnErrorStandsAtItsFieldUntilItIsReadAndInTheListBeyond) {
    const auto reds = [this](int left, int top, int right, int bottom) {
        const Screenshot shot = screenshot();
        int count = 0;
        for (int y = top; y < bottom; ++y)
            for (int x = left; x < right; ++x) {
                const std::uint32_t color = shot.at(x, y);
                count += (color >> 16) > 180 && (color >> 8 & 0xff) < 130 && (color & 0xff) < 130;
            }
        return count;
    };
    const auto atField = [&] { return reds(45, 250, 340, 285); };
    const auto atIcon = [&] { return reds(1247, 6, 1270, 28); };
    const std::string bad = (folder_ / "bad.json").string();
    start();
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_EQ(atField(), 0);
    EXPECT_EQ(atIcon(), 0);
    std::ofstream(bad) << "{";
    ASSERT_TRUE(drop({bad}));
    EXPECT_TRUE(eventually([&] { return atField() > 20; }));
    EXPECT_TRUE(eventually([&] { return atIcon() > 5; }));
    pause(6000); // longer than messages are shown
    EXPECT_GT(atField(), 20);
    click(25, 259); // Dismiss
    EXPECT_TRUE(eventually([&] { return atField() == 0 && atIcon() == 0; }));
    EXPECT_NE(screenshot().at(900, 560), kWindowColor);
    click(1258, 16);
    EXPECT_TRUE(eventually([&] { return screenshot().at(900, 560) == kWindowColor; })); // the list
    key("Escape");
    EXPECT_TRUE(eventually([&] { return screenshot().at(900, 560) != kWindowColor; }));
    expectCleanEnd();
}

TEST_P(SharedPanelsTest, TheHintOfTheFirstRunComesOnce) {
    const auto isHintThere = [this] { return screenshot().at(395, 812) == kWindowColor; };
    const auto isPictureThere = [this] { // and its border
        return isSaved(".exr") && screenshot().at(380, 400) == 0x2b2b2b;
    };
    start();
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_TRUE(eventually(isHintThere));
    key("F12");
    EXPECT_TRUE(appears("Saved")); // the hint stands there, too
    EXPECT_TRUE(eventually(isHintThere));
    expectCleanEnd();
    start();
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_TRUE(eventually([&] {
        key("F12");
        pause(500);
        return isPictureThere();
    }));
    EXPECT_FALSE(isHintThere());
    expectCleanEnd();
}

TEST_P(SharedPanelsTest, ThePictureIsSmoothUnlessItsPixelsAreLargeAndItsBorderNeutral) {
    // Of two pixels of the window beside each other, how many are the same.
    const auto shareOfEqual = [this] {
        const Screenshot shot = screenshot();
        constexpr int kFrom = 500, kTo = 1150;
        int equal = 0;
        for (int x = kFrom; x < kTo; ++x) equal += shot.at(x, 600) == shot.at(x + 1, 600);
        return equal / static_cast<double>(kTo - kFrom);
    };
    foldOutOnly("view");
    start({"--width", "220"}); // fits at less than 400 %
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_TRUE(eventually([&] { return screenshot().at(380, 400) == 0x2b2b2b; })); // grey
    EXPECT_TRUE(eventually([&] { return shareOfEqual() < 0.6; })) << shareOfEqual();
    EXPECT_TRUE(eventually([&] {
        act("mousemove 826 450 sleep 0.3 click 4 sleep 0.5");
        return shareOfEqual() > 0.85; // pixels of seven and more
    })) << shareOfEqual();
    EXPECT_NE(screenshot().at(380, 400), 0x2b2b2bu); // about the pointer
    key("f");
    EXPECT_TRUE(eventually([&] { return shareOfEqual() < 0.6; })) << shareOfEqual();
    expectCleanEnd();
}

TEST_P(SharedPanelsTest, TheToolbarDoesWhatItShows) {
    start({"--width", "48", "--spp", "4", "--engine", isGpu() ? "compute" : "multi"});
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_TRUE(eventually([&] {
        click(986, 16); // Save: too early where there is no picture yet
        return isSaved(".png") && isSaved(".exr");
    })) << log();
    click(957, 16); // A/B
    EXPECT_TRUE(eventually([&] { return screenshot().at(826, 300) == 0xffffff; }));
    click(957, 16);
    EXPECT_TRUE(eventually([&] { return screenshot().at(826, 600) != 0xffffff; }));
    const auto line = [this] {
        const Screenshot shot = screenshot();
        std::vector<std::uint32_t> colors;
        for (int x = 500; x < 1150; ++x) colors.push_back(shot.at(x, 600));
        return colors;
    };
    const auto radiance = line();
    click(332, 16); // Albedo
    EXPECT_TRUE(eventually([&] { return line() != radiance; }));
    click(265, 16); // Picture
    EXPECT_TRUE(eventually([&] { return line() == radiance; }));
    click(1229, 16); // Help
    EXPECT_TRUE(appears("leave a field, a menu, this help"));
    EXPECT_TRUE(appears("duplicate, delete")); // the second column
    EXPECT_NE(line(), radiance);
    click(1229, 16);
    EXPECT_TRUE(eventually([&] { return line() == radiance; }));
    click(1171, 16); // Statistics
    EXPECT_TRUE(eventually([&] { return settings()["open_panels"]["statistics"] == true; })) << settings();
    click(1142, 16); // Comparison
    EXPECT_TRUE(eventually([&] { return settings()["show_comparison"] == true; })) << settings();
    expectCleanEnd();
}

// At the pointer; where the window ends it moves to where it is seen as a whole.
TEST_P(SharedPanelsTest, TheInspectorIsNeverClipped) {
    struct Box {
        int left = kWidth, top = kHeight, right = 0, bottom = 0; // where two screens differ
        bool operator==(const Box&) const = default;
    };
    foldOutOnly("view");
    start();
    ASSERT_FALSE(HasFatalFailure());
    act("mousemove 375 40"); // beside the picture
    Screenshot without;
    const auto pictureOf = [](const Screenshot& shot) {
        return std::vector<std::uint32_t>(shot.pixels->begin() + 70 * shot.width,
                                          shot.pixels->begin() + 834 * shot.width);
    };
    EXPECT_TRUE(eventually([&] { // the render has ended
        without = screenshot();
        pause(3000);
        return pictureOf(screenshot()) == pictureOf(without);
    }));
    EXPECT_TRUE(eventually([&] { // again where the machine was too busy to see it
        click(157, 305);         // Inspect pixels
        act("mousemove 600 300");
        pause(2000);
        return pictureOf(screenshot()) != pictureOf(without);
    }));
    int firstColumn = 373; // that is looked at: the picture's
    const auto boxNow = [&] {
        Box box;
        const Screenshot with = screenshot();
        for (int row = 70; row < 834; ++row)
            for (int column = firstColumn; column < kWidth; ++column) {
                if (with.at(column, row) == without.at(column, row)) continue;
                box.left = std::min(box.left, column), box.right = std::max(box.right, column);
                box.top = std::min(box.top, row), box.bottom = std::max(box.bottom, row);
            }
        return box;
    };
    std::string elsewhere = "mousemove 375 40";
    const auto boxAt = [&](int x, int y) {
        act(elsewhere);
        EXPECT_TRUE(eventually([&] { return boxNow().right == 0; })); // where it was before
        act("mousemove " + std::to_string(x) + " " + std::to_string(y));
        Box box;
        EXPECT_TRUE(eventually([&] {
            box = boxNow();
            pause(200); // it has found its size
            return box.right - box.left > 100 && boxNow() == box;
        })) << x
            << ", " << y;
        return box;
    };
    const Box inside = boxAt(600, 300), inCorner = boxAt(1195, 815);
    EXPECT_LT(inside.left, 640);
    EXPECT_LT(inCorner.right, kWidth - 1);
    EXPECT_LT(inCorner.bottom, 833);
    EXPECT_GT(inCorner.bottom - inCorner.top, 0.9 * (inside.bottom - inside.top)); // as many lines
    // Beside a pinned picture: the values of both, and their difference.
    act("mousemove 375 40 key b");
    EXPECT_TRUE(eventually([&] { return screenshot().at(826, 600) == 0xffffff; }));
    pause(1000);
    without = screenshot();
    const Box ofBoth = boxAt(600, 300), ofBothInCorner = boxAt(1195, 815);
    EXPECT_GT(ofBoth.right - ofBoth.left, 1.5 * (inside.right - inside.left));
    EXPECT_LT(ofBothInCorner.right, kWidth - 1);
    EXPECT_LT(ofBothInCorner.bottom, 833);
    EXPECT_GT(ofBothInCorner.right - ofBothInCorner.left, 0.9 * (ofBoth.right - ofBoth.left));
    // Whatever the window's width, its border is seen at both sides.
    firstColumn = 0;
    elsewhere = "mousemove 5 40";
    for (const int width : {700, 420, 240}) {
        resize(width, 860);
        act(elsewhere);
        pause(2000); // the panels have moved
        without = screenshot();
        const Box box = boxAt(width - 40, 450);
        EXPECT_GE(box.left, 0) << width;
        EXPECT_LE(box.right, width - 1) << width;
        const Screenshot with = screenshot();
        const int middle = (box.top + box.bottom) / 2;
        EXPECT_EQ(with.at(box.left, middle), with.at(box.right, middle)) << width;
        EXPECT_NE(with.at(box.left, middle), with.at(box.left + 3, middle)) << width;
    }
    expectCleanEnd();
}

TEST_P(SharedPanelsTest, TheCamerasOfAModelCanBeChosen) {
    const std::string model = (folder_ / "model.gltf").string(); // a triangle, its nine floats in base64
    std::ofstream(model) << R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0, 1, 2]}], "nodes": [{"mesh": 0},
        {"camera": 0, "translation": [0, 0, 3]}, {"camera": 1, "translation": [0.25, 0, 5]}],
        "cameras": [{"name": "near", "type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}},
                    {"name": "remote", "type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri":
        "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
    const auto isSeenFrom = [this](const std::string& place) {
        for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "pictures")) fs::remove(entry);
        key("F12");
        pause(700);
        for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "pictures"))
            if (entry.path().extension() == ".exr" &&
                image::readDescription(entry.path()).value_or("").find(place) != std::string::npos)
                return true;
        return false;
    };
    const std::string nearby = "look_from\\\":[0.0,0.0,3.0]", remote = "look_from\\\":[0.25,0.0,5.0]";
    foldOutOnly("camera");
    start({"--scene", model});
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_TRUE(eventually([&] { return isSeenFrom(nearby); })) << log(); // the first one
    EXPECT_TRUE(eventually([&] { // again where the machine was too busy to see it
        click(247, 218);         // the list
        pause(700);
        click(247, 261); // the second one
        return isSeenFrom(remote);
    })) << log();
    act("keydown w sleep 0.5 keyup w");
    EXPECT_TRUE(eventually([&] { return !isSeenFrom(remote); })) << log();
    key("r"); // back to the one that was chosen
    EXPECT_TRUE(eventually([&] { return isSeenFrom(remote); })) << log();
    expectCleanEnd();
}

} // namespace
} // namespace rt::test
