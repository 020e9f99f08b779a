// Too little memory, in steps from none to enough: whatever it suffices for is done, and what it does not suffice for ends with
// one line and the documented exit code.
#include "tests/program/Program.h"

#if !defined(_WIN32) && !defined(__APPLE__) && !defined(RT_SANITIZED) // sanitizers reserve terabytes

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class Memory : public ProgramTest {};

// What a render needs is had before it starts; once it has its film, nothing is lost.
TEST_F(Memory, ARenderThatFitsIsWritten) {
    const std::vector<std::string> files = {"a.png", "a.exr", "a.albedo.png", "a.depth.exr", "c.rtc"};
    bool filmWasTooLarge = false, isEnough = false;
    for (addressSpace_ = 40'000; addressSpace_ <= 160'000 && !isEnough; addressSpace_ += 3'000) {
        const Outcome outcome =
            cpu({"-q", "--no-config", "--threads", "1", "--width", "900", "--height", "900", "--spp", "1", "--scene",
                 "next-week-two-spheres", "-o", "a.png", "-o", "a.exr", "--checkpoint", "c.rtc"});
        isEnough = outcome.exitCode == 0;
        if (isEnough) break;
        EXPECT_TRUE(failsWith(outcome, 1, "memory")) << addressSpace_;
        const bool isOfFilm = outcome.err.find("not enough memory for an image") != std::string::npos;
        EXPECT_TRUE(isOfFilm || !filmWasTooLarge) << addressSpace_ << ": " << outcome.err;
        filmWasTooLarge = filmWasTooLarge || isOfFilm;
    }
    EXPECT_TRUE(filmWasTooLarge);
    EXPECT_TRUE(isEnough);
    for (const char* file : {"a.png", "a.exr", "c.rtc"}) EXPECT_TRUE(fs::exists(path(file))) << file;
}

// Each by itself: the images beside the picture need memory of their own.
TEST_F(Memory, WhatCannotBeMadeTakesNothingElseAlong) {
    bool isEnough = false;
    for (addressSpace_ = 60'000; addressSpace_ <= 160'000 && !isEnough; addressSpace_ += 4'000) {
        const Outcome outcome =
            cpu({"-q", "--no-config", "--threads", "1", "--width", "900", "--height", "900", "--spp", "1", "--scene",
                 "next-week-two-spheres", "-o", "a.png", "--aov", "albedo,depth,samples"});
        isEnough = outcome.exitCode == 0;
        if (!isEnough) EXPECT_TRUE(failsWith(outcome, 1, "memory")) << addressSpace_;
        const bool hasFilm = outcome.err.find("albedo") != std::string::npos || isEnough;
        EXPECT_EQ(fs::exists(path("a.png")), hasFilm) << addressSpace_ << ": " << outcome.err;
        EXPECT_EQ(fs::exists(path("a.samples.png")), hasFilm) << addressSpace_;
        fs::remove(path("a.png"));
        fs::remove(path("a.samples.png"));
    }
    EXPECT_TRUE(isEnough);
}

// Of 300 000 spheres: reading, compiling and building all run out somewhere, on one thread and on several.
TEST_F(Memory, AScarceScene) {
    for (const char* threads : {"1", "2", "16"}) {
        for (addressSpace_ = 30'000; addressSpace_ <= 120'000; addressSpace_ += 3'000) {
            const Outcome outcome = cpu({"-q", "--no-config", "--threads", threads, "--width", "16", "--height", "16",
                                         "--spp", "1", "--scene", "white-spheres:300000", "-o", "a.pfm"});
            EXPECT_TRUE(outcome.exitCode == 0 ? outcome.err.empty() : bool(failsWith(outcome, 1, "memory")))
                << threads << " threads, " << addressSpace_ << " KiB: " << outcome.exitCode << " " << outcome.err;
        }
    }
}

} // namespace
} // namespace rt::test

#endif
