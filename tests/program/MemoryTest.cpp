// Too little memory, in steps from none to enough: whatever it suffices for is done, and what it does not suffice for
// ends with one line and the documented exit code.
#include "tests/program/Program.h"

#if !defined(_WIN32) && !defined(__APPLE__) && !defined(RT_SANITIZED) // sanitizers reserve terabytes

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class Memory : public ProgramTest {
  protected:
    // KiB with which the program can be loaded.
    std::uint64_t leastToStart() {
        addressSpace_ = 20'000;
        while (addressSpace_ < 500'000 && cpu({"--version"}).exitCode != 0) addressSpace_ += 5'000;
        return addressSpace_;
    }
};

// Once there is a film, its samples are written, whatever else cannot be made.
TEST_F(Memory, NothingOfARenderThatFitsIsLost) {
    const Arguments arguments = {"-q",       "--no-config", "--threads",    "1",     "--width", "900",
                                 "--height", "900",         "--spp",        "1",     "--scene", "next-week-two-spheres",
                                 "-o",       "a.png",       "-o",           "a.exr", "--aov",   "albedo,depth,samples",
                                 "--stats",  "s.json",      "--checkpoint", "c.rtc"};
    const char* const always[] = {"a.png", "a.exr", "a.samples.png", "a.samples.exr", "s.json", "c.rtc"};
    bool filmWasTooLarge = false, somethingFailed = false, isEnough = false;
    const std::uint64_t first = leastToStart();
    for (addressSpace_ = first; addressSpace_ <= first + 200'000 && !isEnough; addressSpace_ += 4'000) {
        const Outcome outcome = cpu(arguments);
        isEnough = outcome.exitCode == 0;
        if (!isEnough) {
            EXPECT_TRUE(failsWith(outcome, 1, "memory")) << addressSpace_;
            const bool isOfFilm = outcome.err.find("not enough memory for an image") != std::string::npos;
            filmWasTooLarge = filmWasTooLarge || isOfFilm;
            if (isOfFilm || !filmWasTooLarge) continue;
            somethingFailed = true;
        }
        for (const char* file : always) EXPECT_TRUE(fs::remove(path(file))) << addressSpace_ << " KiB: " << file;
    }
    EXPECT_TRUE(filmWasTooLarge && somethingFailed && isEnough);
}

// Of 300 000 spheres: reading, compiling and building all run out somewhere, on one thread and on several.
TEST_F(Memory, ASceneThatDoesNotFit) {
    const std::uint64_t first = leastToStart();
    for (const char* threads : {"1", "2", "16"}) {
        for (addressSpace_ = first; addressSpace_ <= first + 90'000; addressSpace_ += 6'000) {
            const Outcome outcome = cpu({"-q", "--no-config", "--threads", threads, "--width", "16", "--height", "16",
                                         "--spp", "1", "--scene", "white-spheres:300000", "-o", "a.pfm"});
            EXPECT_TRUE(outcome.exitCode == 0 ? outcome.err.empty() : bool(failsWith(outcome, 1, "memory")))
                << threads << " threads, " << addressSpace_ << " KiB: " << outcome.exitCode << " " << outcome.err;
        }
    }
}

// The same as a file of 10 MB, whose JSON values allocate where they end.
TEST_F(Memory, ASceneFileThatDoesNotFit) {
    ASSERT_EQ(cpu({"--scene", "white-spheres:150000", "--export-scene", "big.json"}).exitCode, 0);
    int refused = 0;
    const std::uint64_t first = leastToStart();
    for (addressSpace_ = first; addressSpace_ <= first + 54'000; addressSpace_ += 6'000) {
        const Outcome outcome = cpu({"-q", "--no-config", "--threads", "1", "--width", "16", "--height", "16", "--spp",
                                     "1", "--scene", "big.json", "-o", "a.pfm"});
        refused += outcome.exitCode != 0;
        const int expected = outcome.exitCode == 3 ? 3 : 1; // the file's text does not fit
        EXPECT_TRUE(outcome.exitCode == 0 ? outcome.err.empty() : bool(failsWith(outcome, expected, "memory")))
            << addressSpace_ << " KiB: " << outcome.exitCode << " " << outcome.err;
    }
    EXPECT_GT(refused, 3);
}

} // namespace
} // namespace rt::test

#endif
