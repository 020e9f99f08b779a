// Files that are opened, watched, saved and exported by way of a window.
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "Common/Image/ImageIo.h"
#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class WindowFilesTest : public WindowTest {
  protected:
    void openPath(const std::string& path) {
        key("ctrl+o"); // the field is empty then
        pause(1500);   // for a frame or two of a busy machine
        type(path);
        pause(500);
        key("Return");
    }
};
INSTANTIATE_TEST_SUITE_P(, WindowFilesTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, WindowFilesTest, kSecondProgram, nameOfProgram);

TEST_P(WindowFilesTest, OpensFilesAndKeepsTheSceneWhereTheyAreBad) {
    const fs::path good = writeScene("good.json", "Just opened"), bad = folder_ / "bad.json";
    std::ofstream(bad) << R"({"camera": 12)";
    start();
    ASSERT_FALSE(HasFatalFailure());
    const std::string before = title();
    openPath(bad.string());
    ASSERT_TRUE(eventually([&] { return log().find("bad.json") != std::string::npos; })) << log();
    EXPECT_EQ(title(), before);
    openPath((folder_ / "missing.obj").string());
    ASSERT_TRUE(eventually([&] { return log().find("missing.obj") != std::string::npos; })) << log();
    EXPECT_EQ(title(), before);
    openPath(good.string());
    EXPECT_TRUE(eventually([&] { return title().find("Just opened") == 0; })) << title() << log();
    expectCleanEnd();
    EXPECT_EQ(settings()["recent"][0], good.string());
}

// By keys alone: a folder, then the second of the files there whose names match.
TEST_P(WindowFilesTest, TheFileBrowserIsWalkedThroughByKeys) {
    writeScene("b-scene.json", "The other");
    writeScene("c-scene.json", "Walked to");
    writeScene("d-other.json", "No match");
    std::ofstream(folder_ / "a-scene.txt") << "no scene";
    start();
    ASSERT_FALSE(HasFatalFailure());
    openPath(folder_.string());
    pause(1000);
    type("scene");
    pause(500);
    for (int i = 0; i < 2; ++i) {
        key("Down");
        pause(300);
    }
    key("Return");
    EXPECT_TRUE(eventually([&] { return title().find("Walked to") == 0; })) << title() << log();
    expectCleanEnd();
}

// What is typed replaces the name that is offered, the second time, too.
TEST_P(WindowFilesTest, SaveAsWritesWhereItIsTold) {
    const fs::path bad = folder_ / "missing" / "as-told.exr", file = folder_ / "as-told.exr";
    start();
    ASSERT_FALSE(HasFatalFailure());
    int patience = 0; // more at each try: a busy machine takes seconds for a few frames
    const auto saveAs = [&](const fs::path& path) {
        ++patience;
        key("ctrl+shift+s"); // too early where there is no picture yet
        pause(1000 * patience);
        type(path.string());
        pause(500 * patience);
        key("Return");
        pause(500 * patience);
    };
    EXPECT_TRUE(eventually([&] {
        saveAs(bad);
        return log().find("cannot write " + bad.string()) != std::string::npos;
    })) << log();
    EXPECT_TRUE(eventually([&] {
        saveAs(file);
        return fs::exists(file);
    })) << log();
    expectCleanEnd();
    EXPECT_EQ(image::readImage(file).width, 48u);
    EXPECT_EQ(settings()["save_folder"], folder_.string());
}

// All of it between two frames: each key finds the field, the selection and the text as the one before has left them.
TEST_P(WindowFilesTest, WhatIsTypedDuringASlowFrameIsTakenKeyByKey) {
    const fs::path first = folder_ / "pictures" / "first.png", second = folder_ / "pictures" / "second.exr";
    start();
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(eventually([&] { // there is a picture
        key("F12");
        pause(500);
        return !fs::is_empty(folder_ / "pictures");
    })) << log();
    freeze(true);
    key("ctrl+shift+s");
    type("none of this");
    key("ctrl+a");
    type(first.string());
    key("Return");
    key("ctrl+shift+s");
    type((folder_ / "pictures" / "secondx.exr").string());
    act("key Left Left Left Left BackSpace Return");
    freeze(false);
    EXPECT_TRUE(eventually([&] { return fs::exists(first) && fs::exists(second); })) << log();
    expectCleanEnd();
}

TEST_P(WindowFilesTest, ASceneFileIsReadAgainWhenItChanges) {
    const fs::path file = writeScene("edited.json", "Before");
    start({"--scene", file.string()});
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(eventually([&] { return title().find("Before") == 0; })) << title() << log();
    pause(1500); // the window knows the file as it is
    writeScene("edited.json", "After the change");
    EXPECT_TRUE(eventually([&] { return title().find("After the change") == 0; })) << title() << log();
    expectCleanEnd();
}

TEST_P(WindowFilesTest, ExportsRunsAndChart) {
    start();
    ASSERT_FALSE(HasFatalFailure());
    key("F3");
    ASSERT_TRUE(eventually([&] { return fs::exists(folder_ / "config" / "ray-tracing" / "history.jsonl"); })) << log();
    for (const auto& [file, label] :
         {std::pair{"ray-tracing-history.csv", "Export CSV"}, {"ray-tracing-errors.png", "Export PNG"}}) {
        // Which is named where the user looks.
        EXPECT_TRUE(clickText(label, [&, file = file] {
            return fs::exists(folder_ / "pictures" / file) && isShown("Saved");
        })) << log();
    }
    std::ifstream csv(folder_ / "pictures" / "ray-tracing-history.csv");
    std::string header, run;
    EXPECT_TRUE(std::getline(csv, header) && std::getline(csv, run));
    EXPECT_NE(run.find(GetParam()), std::string::npos) << run;
    EXPECT_GT(image::readImage(folder_ / "pictures" / "ray-tracing-errors.png").width, 100u);
    expectCleanEnd();
}

} // namespace
} // namespace rt::test
