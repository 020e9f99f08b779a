// Scenes that are loaded on a thread of their own, and loads that are called off.
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneLoader.h"
#include "Common/Core/Interruption.h"
#include "Common/Scene/Edit/ObjectMotion.h"
#include "tests/TempFolder.h"

namespace rt::app {
namespace {

TEST(Interruption, EndsWorkOfItsThreadOnceAsked) {
    EXPECT_NO_THROW(interruptionPoint()); // nobody can ask
    std::atomic<bool> flag{false};
    {
        const Interruptible interruptible(flag);
        EXPECT_NO_THROW(interruptionPoint());
        flag = true;
        EXPECT_THROW(interruptionPoint(), Interrupted);
        EXPECT_NO_THROW(std::thread(interruptionPoint).join()); // another thread's work goes on
    }
    EXPECT_NO_THROW(interruptionPoint());
}

// Whatever a scene is made of, compiling it asks.
TEST(Interruption, CallsEveryKindOfSceneOff) {
    const std::atomic<bool> flag{true};
    const Interruptible interruptible(flag);
    for (const char* scene : {"many-lights:5000", "white-spheres", "cornell-box-lucy", "next-week-earth"})
        EXPECT_THROW(compile(SceneRequest{scene}), Interrupted) << scene;
    const std::string folder = std::string(RT_SOURCE_DIR) + "/Assets/models/";
    EXPECT_THROW(compile(SceneRequest{folder + "cube_multi.obj"}), Interrupted);
}

TEST(SceneLoader, TheLastRequestIsTheOneThatCounts) {
    std::mutex mutex;
    std::vector<std::string> loaded;
    std::atomic<bool> failed{false};
    {
        SceneLoader loader([&](const LoadedScene& result) {
            const std::scoped_lock lock(mutex);
            loaded.push_back(result.request.source);
            failed = failed || result.failure != nullptr;
        });
        loader.request({"many-lights:1000000"}); // seconds
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        loader.request({"one-weekend-default"});
        while (loader.busyWith()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        loader.request({"many-lights:1000000"});
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    } // does not wait for it
    EXPECT_EQ(loaded, std::vector<std::string>{"one-weekend-default"});
    EXPECT_FALSE(failed);
}

TEST(SceneLoader, WhatIsGivenUpIsNotHandedOverAndWasNeverRequested) {
    std::atomic<int> count{0};
    SceneLoader loader([&](const LoadedScene&) { ++count; });
    loader.request({"one-weekend-default"});
    while (loader.busyWith()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    loader.request({"many-lights:1000000"}); // seconds
    EXPECT_FALSE(loader.isWanted({"one-weekend-default"}));
    loader.giveUp();
    EXPECT_FALSE(loader.busyWith());
    EXPECT_EQ(loader.lastRequest().source, "one-weekend-default");
    loader.request({"cornell-box-lights"});
    EXPECT_TRUE(loader.isWanted({"cornell-box-lights"}));
    while (loader.busyWith()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(count, 2);
}

void waitUntil(const std::function<bool()>& condition) {
    while (!condition()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

// Where the first edit would begin from nothing it would see what has become of the model's file.
TEST(SceneLoader, TheFirstEditTakesOverWhatIsShown) {
    const test::TempFolder folder;
    const std::filesystem::path model = folder.path() / "corner.obj", file = folder.path() / "scene.json";
    std::ofstream(model) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\n";
    std::ofstream(file) << R"({"version": 1, "materials": {"m": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}},
        "prototypes": {"corner": [{"type": "mesh", "file": "corner.obj", "material": "m"}]},
        "objects": [{"type": "instance", "prototype": "corner"}, {"type": "instance", "prototype": "corner"}]})";
    std::mutex mutex;
    LoadedScene latest;
    SceneLoader loader([&](LoadedScene loaded) {
        const std::scoped_lock lock(mutex);
        latest = std::move(loaded);
    });
    loader.request({file.string()});
    waitUntil([&] { return loader.isResting(); });
    ASSERT_TRUE(latest.scene);
    scene::SceneDesc scene = loadScene(file.string());
    loader.startEditing(scene);
    waitUntil([&] { return loader.isResting(); });
    EXPECT_EQ(latest.request.edits, 0u) << "what is prepared is not shown";
    const auto move = moved(scene, {"", {1}}, {scene::Translate{{2, 0, 0}}});
    auto ofWindow = move;
    scene::exchange(scene, ofWindow);
    const std::uint64_t expected = compile(scene, true)->hash;
    std::ofstream(model) << "v 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n";
    loader.edit({move}, true);
    waitUntil([&] { return loader.isResting(); });
    ASSERT_EQ(latest.request.edits, 1u);
    ASSERT_TRUE(latest.scene);
    EXPECT_EQ(latest.scene->hash, expected) << "the model was read again";
}

// Another scene does not wait until edits of the one before are prepared.
TEST(SceneLoader, WhatIsPreparedGivesWayToAnotherScene) {
    std::mutex mutex;
    std::vector<std::string> loaded;
    SceneLoader loader([&](const LoadedScene& result) {
        const std::scoped_lock lock(mutex);
        loaded.push_back(result.failure ? "failed" : result.request.source);
    });
    loader.request({"cornell-box-lights"});
    waitUntil([&] { return loader.isResting(); });
    loader.startEditing(loadScene("many-lights:1000000")); // seconds
    loader.request({"one-weekend-default"});
    loader.stopEditing();
    waitUntil([&] { return loader.isResting(); });
    loader.startEditing(loadScene("cornell-box-lights"));
    loader.stopEditing();
    loader.startEditing(loadScene("one-weekend-default"));
    loader.edit({scene::SetTitle{"Edited"}}, false);
    waitUntil([&] { return loader.isResting(); });
    EXPECT_EQ(loaded, (std::vector<std::string>{"cornell-box-lights", "one-weekend-default", "one-weekend-default"}));
}

} // namespace
} // namespace rt::app
