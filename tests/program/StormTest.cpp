// Kills and signals at random times, and programs that write the same files at the same time.
#ifdef __linux__

#include <chrono>
#include <fstream>
#include <random>
#include <signal.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "tests/program/Program.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class NightlyStorm : public ProgramTest {
  protected:
    pid_t launch(const Arguments& arguments) const {
        const std::string program = programPath("ray-tracing-cpu");
        std::vector<char*> argv = {const_cast<char*>(program.c_str())};
        for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
        argv.push_back(nullptr);
        const pid_t child = fork();
        if (child == 0) {
            if (chdir(folder_.c_str()) == 0) execv(program.c_str(), argv.data());
            _exit(99);
        }
        return child;
    }
    static int exitCode(pid_t child) {
        int status = 0;
        waitpid(child, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    }
    // Before that a signal does what it does to any program that has just been started.
    static void waitUntilItHandles(pid_t child, int signal) {
        for (int i = 0; i < 5000; ++i) {
            std::ifstream status("/proc/" + std::to_string(child) + "/status");
            for (std::string line; std::getline(status, line);)
                if (line.rfind("SigCgt:", 0) == 0 &&
                    (std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1) != 0)
                    return;
            std::this_thread::sleep_for(std::chrono::microseconds(200));
        }
    }
    void pauseUpTo(int microseconds) {
        std::this_thread::sleep_for(
            std::chrono::microseconds(std::uniform_int_distribution<int>(0, microseconds)(random_)));
    }
    std::size_t temporaries() const {
        std::size_t count = 0;
        for (const auto& entry : fs::directory_iterator(folder_)) count += entry.path().extension() == ".tmp";
        return count;
    }

    std::mt19937 random_{25};
};

// Whatever the moment, the last checkpoint is whole, and the render ends as if it had never been stopped.
TEST_F(NightlyStorm, KilledRendersGoOn) {
    const Arguments picture = {"--width", "48", "--height", "48", "--spp", "20000"};
    const std::string whole = pixels(picture);
    Arguments arguments = {"-q", "--no-config", "-o", "a.pfm", "--checkpoint", "c.rtc", "--save-every", "0.005"};
    arguments.insert(arguments.end(), picture.begin(), picture.end());
    int kills = 0, ends = 0;
    for (int round = 0; round < 200; ++round) {
        Arguments all = arguments;
        if (fs::exists(path("c.rtc"))) all.insert(all.end(), {"--resume", "c.rtc"});
        const pid_t child = launch(all);
        pauseUpTo(150'000);
        kill(child, SIGKILL);
        const int code = exitCode(child);
        ASSERT_TRUE(code == 0 || code == 1000 + SIGKILL) << round << ": " << code;
        kills += code != 0;
        if (!fs::exists(path("a.pfm"))) continue;
        EXPECT_TRUE(bytesOf("a.pfm") == whole) << round;
        ++ends;
        fs::remove(path("a.pfm"));
        fs::remove(path("c.rtc"));
    }
    EXPECT_GT(kills, 100);
    Arguments last = picture;
    if (fs::exists(path("c.rtc"))) last.insert(last.end(), {"--resume", "c.rtc"});
    EXPECT_TRUE(pixels(last) == whole) << ends << " renders ended before";
}

TEST_F(NightlyStorm, SignalsAtAnyMoment) {
    const std::string whole = pixels({"--width", "48", "--height", "48", "--spp", "3000"});
    int interrupted = 0, kept = 0;
    for (int round = 0; round < 300; ++round) {
        for (const char* file : {"a.pfm", "b.png", "s.json", "c.rtc"}) fs::remove(path(file));
        const int signal = round % 3 == 0 ? SIGINT : round % 3 == 1 ? SIGTERM : SIGHUP;
        const pid_t child = launch({"-q", "--no-config", "--width", "48", "--height", "48", "--spp", "3000", "-o",
                                    "a.pfm", "-o", "b.png", "--stats", "s.json", "--checkpoint", "c.rtc"});
        waitUntilItHandles(child, signal);
        pauseUpTo(120'000);
        kill(child, signal);
        const int code = exitCode(child);
        ASSERT_TRUE(code == 0 || code == 130 || code == 1000 + signal) << round << ": " << code;
        // What was installed before main comes back at its end: all is written by then.
        EXPECT_TRUE(code != 1000 + signal || fs::exists(path("s.json"))) << round;
        interrupted += code == 130;
        EXPECT_EQ(temporaries(), 0u) << round;
        const bool hasAll = fs::exists(path("a.pfm")) && fs::exists(path("b.png")) && fs::exists(path("s.json")) &&
                            fs::exists(path("c.rtc"));
        EXPECT_TRUE(code != 0 || (hasAll && bytesOf("a.pfm") == whole)) << round;
        if (code != 130) continue;
        EXPECT_EQ(hasAll, fs::exists(path("a.pfm"))) << round; // none while the scene is loaded
        if (!hasAll) continue;
        ++kept;
        EXPECT_EQ(jsonOf("s.json")["stopped_by"], "interrupted");
        if (round % 10 != 0) continue;
        EXPECT_TRUE(pixels({"--width", "48", "--height", "48", "--spp", "3000", "--resume", "c.rtc"}) == whole)
            << round;
    }
    EXPECT_GT(interrupted, 50);
    EXPECT_GT(kept, 20);
}

// The files are those of the one or of the other, never a mixture.
TEST_F(NightlyStorm, TwoWritersToTheSameFiles) {
    const Arguments common = {"-q",    "--no-config", "--threads", "1",      "--width",      "48",   "--height",
                              "48",    "--spp",       "4",         "-o",     "a.pfm",        "-o",   "e.exr",
                              "--aov", "albedo",      "--stats",   "s.json", "--checkpoint", "c.rtc"};
    const char* const files[] = {"a.pfm", "a.albedo.pfm", "e.exr", "e.albedo.exr", "c.rtc"};
    const auto withSeed = [&common](const char* seed) {
        Arguments arguments = common;
        arguments.insert(arguments.end(), {"--seed", seed});
        return arguments;
    };
    std::map<std::string, std::string> whole[2];
    for (int seed = 0; seed < 2; ++seed) {
        ASSERT_EQ(exitCode(launch(withSeed(seed == 0 ? "0" : "1"))), 0);
        for (const char* file : files) whole[seed][file] = bytesOf(file);
    }
    for (int round = 0; round < 150; ++round) {
        const pid_t one = launch(withSeed("0"));
        pauseUpTo(10'000);
        const pid_t other = launch(withSeed("1"));
        EXPECT_EQ(exitCode(one), 0);
        EXPECT_EQ(exitCode(other), 0);
        for (const char* file : files) {
            const std::string bytes = bytesOf(file);
            EXPECT_TRUE(bytes == whole[0][file] || bytes == whole[1][file]) << round << ": " << file;
        }
        EXPECT_EQ(jsonOf("s.json")["spp_done"], 4);
        EXPECT_EQ(temporaries(), 0u);
    }
}

} // namespace
} // namespace rt::test

#endif
