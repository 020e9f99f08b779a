// Scenes that are loaded on a thread of their own, and loads that are called off.
#include <atomic>
#include <chrono>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneLoader.h"
#include "Common/Core/Interruption.h"

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
        SceneLoader loader([&](LoadedScene result) {
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
    SceneLoader loader([&](LoadedScene) { ++count; });
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

} // namespace
} // namespace rt::app
