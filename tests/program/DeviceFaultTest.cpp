// A device that is lost at each submission in turn (tests/layer/FaultLayer.cpp): what was there is kept, nothing
// hangs, and going on from it gives the same bits.
#include "tests/program/Program.h"

#if defined(RT_LAYER_DIR) && !defined(RT_SANITIZED) // the driver is not compiled with sanitizers

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class DeviceFault : public ProgramTest {
  protected:
    Outcome gpu(Arguments arguments, const std::string& engine, const std::string& faults = "") const {
        arguments.insert(arguments.begin(),
                         {"-q", "--headless", "--width", "32", "--height", "32", "--engine", engine});
        return run(
            "ray-tracing-gpu", arguments,
            {{"VK_ADD_LAYER_PATH", RT_LAYER_DIR}, {"VK_INSTANCE_LAYERS", "VK_LAYER_RT_faults"}, {"RT_FAULTS", faults}});
    }

    // Loses the device at submission `first` and every `stride`-th from there, each in a run of its own.
    void expectNothingIsLost(const std::string& engine, int first, int stride) {
        ASSERT_EQ(gpu({"--spp", "40", "-o", "whole.pfm"}, engine).exitCode, 0);
        ASSERT_EQ(gpu({"--spp", "16", "-o", "part.pfm", "--checkpoint", "part.rtc"}, engine).exitCode, 0);
        const std::string whole = bytesOf("whole.pfm"), part = bytesOf("part.rtc");
        int lost = 0;
        for (int n = first;; n += stride, ++lost) {
            for (const char* file : {"a.pfm", "a.albedo.pfm", "s.json", "c.rtc"}) fs::remove(path(file));
            Outcome outcome = gpu({"--spp", "40", "--resume", "part.rtc", "--checkpoint", "c.rtc", "-o", "a.pfm",
                                   "--aov", "albedo", "--stats", "s.json"},
                                  engine, "vkQueueSubmit:" + std::to_string(n) + "=-4");
            const std::string fault = "fault vkQueueSubmit:" + std::to_string(n) + "=-4\n";
            const std::size_t at = outcome.err.find(fault);
            if (at == std::string::npos) {
                EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
                EXPECT_TRUE(bytesOf("a.pfm") == whole);
                break;
            }
            outcome.err.erase(at, fault.size());
            EXPECT_TRUE(failsWith(outcome, 1, "lost")) << engine << ' ' << n;
            EXPECT_TRUE(bytesOf("part.rtc") == part) << n;
            const std::string kept = fs::exists(path("c.rtc")) ? "c.rtc" : "part.rtc";
            EXPECT_EQ(kept == "c.rtc", fs::exists(path("a.pfm"))) << engine << ' ' << n;
            EXPECT_EQ(gpu({"--spp", "40", "--resume", kept, "-o", "b.pfm"}, engine).exitCode, 0) << n;
            EXPECT_TRUE(bytesOf("b.pfm") == whole) << engine << ' ' << n;
        }
        EXPECT_GT(lost, 0);
    }
};

TEST_F(DeviceFault, LostOnTheWay) {
    constexpr int kMiddle = 12, kNoMore = 1000;
    expectNothingIsLost("pipeline", kMiddle, kNoMore);

    // With nothing to keep, the picture of another day stays.
    writeFile("a.pfm", "of another day");
    const Outcome outcome =
        gpu({"--spp", "40", "-o", "a.pfm"}, "pipeline", "vkQueueSubmit:" + std::to_string(kMiddle) + "=-4");
    EXPECT_EQ(outcome.exitCode, 1) << outcome.err;
    EXPECT_EQ(bytesOf("a.pfm"), "of another day");
}

using NightlyDeviceFault = DeviceFault;

TEST_F(NightlyDeviceFault, LostAtEachSubmission) {
    for (const char* engine : {"pipeline", "compute"}) expectNothingIsLost(engine, 1, 1);
}

} // namespace
} // namespace rt::test

#endif
