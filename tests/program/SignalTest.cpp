// Ctrl-C and SIGTERM: the first keeps what there is, the second ends at once.
#ifndef _WIN32

#include <chrono>
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "Common/Image/ImageIo.h"
#include "tests/program/Program.h"

namespace rt::test {
namespace {

using Clock = std::chrono::steady_clock;

class Signal : public ProgramTest {
  protected:
    // Starts a render that takes years, and waits until its first checkpoint shows that it is under way.
    pid_t start(Arguments arguments, const char* name = "ray-tracing-cpu") {
        arguments.insert(arguments.begin(), {"-q", "--width", "64", "--spp", "2147483647", "--stats", "s.json", "-o",
                                             "a.pfm", "--checkpoint", "c.rtc", "--save-every", "0.01"});
        const std::string program = programPath(name);
        std::vector<char*> argv = {const_cast<char*>(program.c_str())};
        for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
        argv.push_back(nullptr);
        const pid_t child = fork();
        if (child == 0) {
            if (chdir(folder_.c_str()) == 0) execv(program.c_str(), argv.data());
            _exit(99);
        }
        const auto end = Clock::now() + std::chrono::seconds(60);
        while (!std::filesystem::exists(path("c.rtc")) && Clock::now() < end)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        return child;
    }
    static int exitCode(pid_t child) {
        int status = 0;
        waitpid(child, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    }
};

TEST_F(Signal, InterruptedRendersKeepPictureStatisticsAndCheckpoint) {
    for (const int signal : {SIGINT, SIGTERM}) {
        std::filesystem::remove(path("c.rtc"));
        const pid_t child = start({});
        kill(child, signal);
        EXPECT_EQ(exitCode(child), 130);
        const auto stats = jsonOf("s.json");
        EXPECT_EQ(stats["stopped_by"], "interrupted");
        EXPECT_EQ(image::readImage(path("a.pfm")).width, 64u);

        // What the checkpoint holds is what the picture shows, and going on from it ends where a whole render ends.
        const std::string more = std::to_string(stats["spp_done"].get<int>() + 40);
        EXPECT_TRUE(pixels({"--width", "64", "--height", "64", "--spp", more, "--resume", "c.rtc"}) ==
                    pixels({"--width", "64", "--height", "64", "--spp", more}));
    }
}

#ifdef RT_HAS_GPU

TEST_F(Signal, TheGpuKeepsPictureAndStatisticsToo) {
    const pid_t child = start({}, "ray-tracing-gpu");
    const auto begin = Clock::now();
    kill(child, SIGINT);
    EXPECT_EQ(exitCode(child), 130);
    EXPECT_LT(Clock::now() - begin, std::chrono::seconds(10));
    const auto stats = jsonOf("s.json");
    EXPECT_EQ(stats["stopped_by"], "interrupted");
    EXPECT_TRUE(stats["engine"] == "pipeline" || stats["engine"] == "compute");
    EXPECT_EQ(image::readImage(path("a.pfm")).width, 64u);
    const std::string more = std::to_string(stats["spp_done"].get<int>() + 100);
    const Arguments common = {"-q", "--width", "64", "--height", "64", "--spp", more, "--headless"};
    const auto render = [&](Arguments arguments) {
        arguments.insert(arguments.begin(), common.begin(), common.end());
        EXPECT_EQ(run("ray-tracing-gpu", arguments).exitCode, 0);
    };
    render({"--resume", "c.rtc", "-o", "resumed.pfm"});
    render({"-o", "whole.pfm"});
    EXPECT_TRUE(bytesOf("resumed.pfm") == bytesOf("whole.pfm"));
}

#endif

TEST_F(Signal, TheSecondEndsAtOnce) {
    // A pipe that nobody reads holds the first one up while it writes its picture.
    ASSERT_EQ(mkfifo(path("a.png").c_str(), 0600), 0);
    const int reader = open(path("a.png").c_str(), O_RDONLY | O_NONBLOCK);
    const pid_t child = start({"-o", "a.png", "--height", "4096"});
    kill(child, SIGINT);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    kill(child, SIGINT);
    EXPECT_EQ(exitCode(child), 130);
    close(reader);
}

} // namespace
} // namespace rt::test

#endif
