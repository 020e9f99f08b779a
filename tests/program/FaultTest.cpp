// Writes, synchronisations and renames that fail, one after the other, and signals before files are removed
// (tests/layer/FaultCalls.cpp): nothing is lost that could be kept, and the program ends with one line and the
// documented exit code.
#include "tests/program/Program.h"

#if defined(RT_FAULT_CALLS) && !defined(RT_SANITIZED) // sanitizers want to be loaded first

#include <algorithm>
#include <csignal>
#include <sstream>

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class Fault : public ProgramTest {
  protected:
    // Two pictures, statistics and a checkpoint. One thread: the same calls each time.
    Outcome renderWith(const std::string& faults) const {
        fs::remove(path("calls"));
        return render({"--no-config", "--threads", "1", "--policy", "seq", "-o", "a.pfm", "-o", "b.exr", "--stats",
                       "s.json", "--checkpoint", "c.rtc"},
                      {{"LD_PRELOAD", RT_FAULT_CALLS}, {"RT_CALL_FAULTS", faults}, {"RT_CALL_LOG", path("calls")}});
    }
    std::vector<std::string> calls() const {
        std::istringstream lines(bytesOf("calls"));
        std::vector<std::string> list;
        for (std::string line; std::getline(lines, line);) list.push_back(line);
        return list;
    }
    void expectNoTemporaries() const {
        for (const auto& entry : fs::directory_iterator(folder_)) EXPECT_NE(entry.path().extension(), ".tmp");
    }
};

TEST_F(Fault, ACheckpointIsOnDiskBeforeItReplacesTheLast) {
    ASSERT_EQ(renderWith("").exitCode, 0);
    const std::vector<std::string> list = calls();
    const auto at = [&](const char* call) { return std::find(list.begin(), list.end(), call) - list.begin(); };
    EXPECT_LT(at("write"), at("fsync"));
    EXPECT_EQ(at("fsync") + 1, at("rename"));                                // the checkpoint comes first
    EXPECT_EQ(list.at(static_cast<std::size_t>(at("rename")) + 1), "fsync"); // of the folder

    writeFile("c.rtc", "the last one");
    EXPECT_TRUE(failsWith(renderWith("fsync:1=5"), 1, "c.rtc"));
    EXPECT_EQ(bytesOf("c.rtc"), "the last one");
    expectNoTemporaries();
}

// Each output is tried before anything is rendered, by a file that is removed again.
TEST_F(Fault, SignalsWhileOutputsAreTriedLeaveNothing) {
    ASSERT_EQ(renderWith("").exitCode, 0);
    const std::vector<std::string> all = calls();
    const std::ptrdiff_t count = std::count(all.begin(), all.end(), "remove");
    EXPECT_EQ(count, 4);
    for (std::ptrdiff_t n = 1; n <= count; ++n)
        for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
            for (const char* file : {"a.pfm", "b.exr", "s.json", "c.rtc"}) fs::remove(path(file));
            const Outcome outcome = renderWith("remove:" + std::to_string(n) + "=" + std::to_string(signal));
            EXPECT_EQ(outcome.exitCode, 130) << n << ' ' << signal;
            EXPECT_FALSE(fs::exists(path("a.pfm"))) << n << ' ' << signal;
            expectNoTemporaries();
        }
}

TEST_F(Fault, EachWriteAndRename) {
    ASSERT_EQ(renderWith("").exitCode, 0);
    const std::vector<std::string> all = calls();
    const char* const files[] = {"a.pfm", "b.exr", "s.json", "c.rtc"};
    std::string whole[2] = {bytesOf("a.pfm"), bytesOf("c.rtc")};
    for (const std::string call : {"write", "rename"})
        for (std::ptrdiff_t n = 1; n <= std::count(all.begin(), all.end(), call); ++n) {
            for (const char* file : files) fs::remove(path(file));
            const Outcome outcome = renderWith(call + ":" + std::to_string(n) + "=28"); // ENOSPC
            EXPECT_TRUE(failsWith(outcome, 1, "No space left")) << call << ' ' << n;
            const auto missing = std::count_if(std::begin(files), std::end(files),
                                               [this](const char* file) { return !fs::exists(path(file)); });
            EXPECT_EQ(missing, 1) << call << ' ' << n; // the others are written
            expectNoTemporaries();
            if (call != "write") continue;
            EXPECT_EQ(renderWith("write:" + std::to_string(n) + "=0").exitCode, 0) << n; // short: goes on
            EXPECT_TRUE(bytesOf("a.pfm") == whole[0] && bytesOf("c.rtc") == whole[1]) << n;
        }
}

} // namespace
} // namespace rt::test

#endif
