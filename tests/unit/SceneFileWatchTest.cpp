// Scenes whose files change on the disk, those of models that they have taken in among them.
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Interactive/SceneFileWatch.h"
#include "tests/unit/InteractiveFixture.h"

namespace rt::app {
namespace {

namespace fs = std::filesystem;

class SceneFileWatchTest : public InteractiveFixture {
  protected:
    std::string write(const std::string& name, const std::string& text) const {
        const fs::path file = folder_.path() / name;
        std::ofstream(file) << text;
        return file.generic_string();
    }
    static std::vector<WatchedFile> asTheyAre(const std::vector<std::string>& files) {
        std::vector<WatchedFile> watched;
        watched.reserve(files.size());
        for (const std::string& file : files) watched.push_back({file, {markOf(file)}});
        return watched;
    }
};

TEST_F(SceneFileWatchTest, AChangeCountsOnceItStays) {
    const std::string a = write("a", "1"), b = write("b", "1");
    const std::vector<WatchedFile> files = asTheyAre({a, b});
    SceneFileWatch watch;
    for (int look = 0; look < 3; ++look) EXPECT_FALSE(watch.isDue(files)) << look;
    write("b", "12");
    EXPECT_FALSE(watch.isDue(files)) << "it may still be being written";
    write("b", "123");
    EXPECT_FALSE(watch.isDue(files));
    EXPECT_TRUE(watch.isDue(files));
    EXPECT_TRUE(watch.isDue(files)) << "until it is asked for";
    watch.setAsked();
    EXPECT_FALSE(watch.isDue(files)) << "also where it does not load";
    write("a", "12");
    EXPECT_FALSE(watch.isDue(files));
    EXPECT_TRUE(watch.isDue(files));
    const std::vector<WatchedFile> read = asTheyAre({a, b});
    EXPECT_FALSE(watch.isDue(read));
    fs::remove(b);
    for (int look = 0; look < 3; ++look) EXPECT_FALSE(watch.isDue(read)) << "there will be another one";
    write("b", "1");
    EXPECT_FALSE(watch.isDue(read));
    EXPECT_TRUE(watch.isDue(read));
    const std::vector<WatchedFile> own{{a, {markOf(a)}}, {b, {std::nullopt, markOf(b)}}};
    for (int look = 0; look < 3; ++look) EXPECT_FALSE(watch.isDue(own)) << "what this program has written";
}

TEST_F(SceneFileWatchTest, WhatIsWrittenWhileItIsReadCountsAsAnotherFile) {
    const std::string file = write("model", "1");
    const auto written = fs::last_write_time(file);
    EXPECT_EQ(marksOfRead({file}, written + std::chrono::seconds(1)).at(0), markOf(file));
    EXPECT_NE(marksOfRead({file}, written - std::chrono::seconds(1)).at(0), markOf(file));
    EXPECT_EQ(marksOfRead({"no such file"}, written).size(), 1u);
    std::vector<FileFingerprint> marks = {{"a", {}, 1}, {"b", {}, 1}};
    keepMarks({{"b", {}, 2}, {"c", {}, 2}}, marks);
    EXPECT_EQ(marks, (std::vector<FileFingerprint>{{"a", {}, 1}, {"b", {}, 2}}));
}

// What the scene says of the model holds for what the file has become.
TEST_F(SceneFileWatchTest, AnAddedModelIsReadAgainWithTheEditsOnTop) {
    const auto modelOf = [](const std::string& radius) {
        return R"({"materials": {"m": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}},
                   "objects": [{"type": "sphere", "center": [0, 0, 0], "material": "m", "radius": )" +
               radius + "}]}";
    };
    const std::string model = write("ball.json", modelOf("1"));
    auto setup = InteractiveFixture::setup(16);
    setup.scene.source = write("scene.json", R"({"models": {"ball": {"file": "ball.json"}},
        "background": {"type": "constant", "color": [1, 1, 1]},
        "materials": {"ball: m": {"type": "metal", "albedo": [1, 0, 0]}},
        "objects": [{"type": "instance", "prototype": "ball"}]})");
    InteractiveSession session(setup);
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.sceneLoads == 1; }));
    SceneFileWatch watch;
    const auto isDue = [&] {
        const SessionState state = session.state();
        std::vector<WatchedFile> files{{state.source, {state.sourceMark}}};
        for (const FileFingerprint& mark : state.modelMarks) files.push_back({mark.file, {mark}});
        return watch.isDue(files);
    };
    ASSERT_EQ(session.state().modelMarks.size(), 1u);
    EXPECT_EQ(session.state().modelMarks[0].file, model);
    EXPECT_FALSE(isDue());
    EXPECT_FALSE(isDue());
    write("ball.json", modelOf("0.25"));
    EXPECT_FALSE(isDue());
    ASSERT_TRUE(isDue());
    const auto reopens = [&](const SessionState& state) { return session.reopen(state.source); };
    ASSERT_TRUE(reaches(session, reopens)); // which it refuses before all of the first load is done
    watch.setAsked();
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.sceneLoads == 2; }));
    const auto scene = session.state().scene;
    ASSERT_EQ(scene->spheres.size(), 1u);
    EXPECT_EQ(scene->spheres[0].radius, 0.25f);
    EXPECT_EQ(scene->materials[scene->spheres[0].material].albedo, shared::vec3(1, 0, 0));
    EXPECT_FALSE(isDue());
    EXPECT_FALSE(isDue());
}

} // namespace
} // namespace rt::app
