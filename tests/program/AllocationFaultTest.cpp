// Allocations that fail, one after the other (tests/layer/FaultAllocations.cpp): the program ends as documented, and
// each file is whole or absent.
#include "tests/program/Program.h"

#if defined(RT_FAULT_ALLOCATIONS) && !defined(RT_SANITIZED) // sanitizers want to be loaded first

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class AllocationFault : public ProgramTest {
  protected:
    Outcome renderWith(const std::string& fault) const {
        for (const auto& entry : fs::directory_iterator(folder_)) fs::remove_all(entry);
        Arguments arguments = {"--no-config", "--threads",    threads_, "--aov",   "albedo,variance", "--replicates",
                               "2",           "--checkpoint", "c.rtc",  "--stats", "s.json"};
        for (const char* file : {"a.pfm", "b.png", "e.exr"}) arguments.insert(arguments.end(), {"-o", file});
        return render(arguments, {{"LD_PRELOAD", RT_FAULT_ALLOCATIONS},
                                  {"RT_ALLOCATION_FAULT", fault},
                                  {"RT_ALLOCATION_COUNT", folder_.string() + ".count"}});
    }
    // What the folder holds. Statistics hold times: that they can be read is enough.
    std::map<std::string, std::string> files() const {
        std::map<std::string, std::string> files;
        for (const auto& entry : fs::directory_iterator(folder_)) {
            const std::string name = entry.path().filename().string();
            files[name] = name == "s.json" ? jsonOf(name)["app"].get<std::string>() : bytesOf(name);
        }
        return files;
    }

    // Allocation `first` and every `stride`-th from there fails, each in a run of its own; `after` is what follows its
    // number in RT_ALLOCATION_FAULT.
    void expectOneLineAndWholeFiles(long first, long stride, const std::string& after) {
        ASSERT_EQ(renderWith("").exitCode, 0);
        const auto whole = files();
        EXPECT_EQ(whole.size(), 11u);
        const long count = std::stol(bytesOf(folder_.string() + ".count"));
        ASSERT_GT(count, 1000);
        int failed = 0;
        for (long n = first; n <= count; n += stride) {
            const Outcome outcome = renderWith(std::to_string(n) + after);
            const auto left = files();
            failed += outcome.exitCode != 0;
            EXPECT_TRUE(outcome.exitCode == 0 ? outcome.err.empty() && left.size() == whole.size()
                                              : bool(failsWith(outcome, 1, "not enough memory")))
                << n << after << ": " << outcome.exitCode << ' ' << outcome.err;
            EXPECT_TRUE(left.empty() || left.count("c.rtc") == 1) << n << after; // nothing that was rendered is lost
            const bool isPart = left.count("s.json") == 1 && jsonOf("s.json")["stopped_by"] == "failure";
            for (const auto& [name, bytes] : left)
                EXPECT_TRUE(whole.count(name) == 1 && (isPart || whole.at(name) == bytes))
                    << n << after << ": " << name;
            EXPECT_TRUE(!isPart || jsonOf("s.json")["mean_radiance"][0].get<double>() > 0) << n << after; // not black
            EXPECT_TRUE(!isPart ||
                        pixels({"--no-config", "--replicates", "2", "--resume", "c.rtc"}) == whole.at("a.pfm"))
                << n << after;
        }
        EXPECT_TRUE(failed > 0 || after.empty());
        fs::remove(folder_.string() + ".count");
    }

    std::string threads_ = "1";
};

// In all but one case of a thousand the reserve of MemoryReserve.h answers: the render goes on.
constexpr const char* kOnlyThat = "";
// Memory is full but for what the reserve would be. Less would not do for the destructors of JSON values.
constexpr const char* kThatAndLaterOnes = "+16384";

TEST_F(AllocationFault, SomeOfThem) {
    expectOneLineAndWholeFiles(1, 311, kOnlyThat);
    expectOneLineAndWholeFiles(50, 311, kThatAndLaterOnes);
}

using NightlyAllocationFault = AllocationFault;

TEST_F(NightlyAllocationFault, Each) {
    expectOneLineAndWholeFiles(1, 1, kOnlyThat);
}

TEST_F(NightlyAllocationFault, EachAndLaterOnes) {
    expectOneLineAndWholeFiles(1, 1, kThatAndLaterOnes);
}

// Their order differs from run to run, but each is met sooner or later.
TEST_F(NightlyAllocationFault, OnThreads) {
    threads_ = "3";
    expectOneLineAndWholeFiles(1, 3, kOnlyThat);
    expectOneLineAndWholeFiles(2, 3, kThatAndLaterOnes);
}

} // namespace
} // namespace rt::test

#endif
