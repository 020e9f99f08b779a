// Ctrl-C, SIGTERM and SIGHUP: the first keeps what there is, the second ends at once. Readers that go or stall.
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
        const pid_t child = launch(arguments, name, [] {});
        const auto end = Clock::now() + std::chrono::seconds(60);
        while (!std::filesystem::exists(path("c.rtc")) && Clock::now() < end)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        return child;
    }
    // `prepare` acts in the child.
    template <class Prepare>
    pid_t launch(const Arguments& arguments, const char* name, const Prepare& prepare) {
        const std::string program = programPath(name);
        std::vector<char*> argv = {const_cast<char*>(program.c_str())};
        for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
        argv.push_back(nullptr);
        const pid_t child = fork();
        if (child == 0) {
            prepare();
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
};

TEST_F(Signal, InterruptedRendersKeepPictureStatisticsAndCheckpoint) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
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
    const pid_t child = start({"--engine", "compute"}, "ray-tracing-gpu");
    const auto begin = Clock::now();
    kill(child, SIGINT);
    EXPECT_EQ(exitCode(child), 130);
    EXPECT_LT(Clock::now() - begin, std::chrono::seconds(10));
    const auto stats = jsonOf("s.json");
    EXPECT_EQ(stats["stopped_by"], "interrupted");
    EXPECT_EQ(image::readImage(path("a.pfm")).width, 64u);
    const std::string more = std::to_string(stats["spp_done"].get<int>() + 100);
    const Arguments common = {"-q",    "--width", "64",         "--height", "64",
                              "--spp", more,      "--headless", "--engine", "compute"};
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
    ASSERT_EQ(mkfifo(path("b.pfm").c_str(), 0600), 0);
    const int reader = open(path("b.pfm").c_str(), O_RDONLY | O_NONBLOCK);
    const pid_t child = start({"-o", "b.pfm", "--height", "4096"});
    kill(child, SIGINT);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    kill(child, SIGINT);
    EXPECT_EQ(exitCode(child), 130);
    close(reader);
}

TEST_F(Signal, AHangUpThatIsIgnoredStaysSo) {
    const auto before = signal(SIGHUP, SIG_IGN); // as nohup does; the program inherits it
    const pid_t child = start({});
    signal(SIGHUP, before);
    kill(child, SIGHUP);
    std::filesystem::remove(path("c.rtc"));
    const auto end = Clock::now() + std::chrono::seconds(60);
    while (!std::filesystem::exists(path("c.rtc")) && Clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_TRUE(std::filesystem::exists(path("c.rtc"))); // it goes on
    EXPECT_FALSE(std::filesystem::exists(path("a.pfm")));
    kill(child, SIGTERM);
    EXPECT_EQ(exitCode(child), 130);
}

TEST_F(Signal, AReaderThatStallsIsLeftAtTheFirst) {
    ASSERT_EQ(mkfifo(path("b.pfm").c_str(), 0600), 0);
    const int reader = open(path("b.pfm").c_str(), O_RDONLY | O_NONBLOCK);
    const pid_t child = start({"-o", "b.pfm", "--height", "4096"});
    kill(child, SIGTERM);
    EXPECT_EQ(exitCode(child), 1); // as that picture is not written
    EXPECT_EQ(image::readImage(path("a.pfm")).height, 4096u);
    EXPECT_EQ(jsonOf("s.json")["stopped_by"], "interrupted");
    close(reader);
}

// Only progress suffers, as with `2>&1 | head -1` or `2>&-`.
TEST_F(Signal, NobodyNeedsToReadStandardError) {
    const Arguments arguments = {"--no-config", "--width", "64", "--spp", "4", "-o", "a.pfm", "--features", "all"};
    const std::string expected = pixels({"--width", "64", "--height", "64", "--spp", "4"});
    const auto toReaderThatWent = [] {
        int ends[2];
        if (pipe(ends) != 0) _exit(98);
        dup2(ends[1], STDERR_FILENO);
        close(ends[0]);
        close(ends[1]);
    };
    EXPECT_EQ(exitCode(launch(arguments, "ray-tracing-cpu", toReaderThatWent)), 0);
    EXPECT_TRUE(bytesOf("a.pfm") == expected);
    EXPECT_EQ(exitCode(launch(arguments, "ray-tracing-cpu", [] { close(STDERR_FILENO); })), 0);
    EXPECT_TRUE(bytesOf("a.pfm") == expected);
}

} // namespace
} // namespace rt::test

#endif
