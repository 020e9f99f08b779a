#include "tests/program/Program.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "tests/FileBytes.h"

#ifndef _WIN32
#include <sys/wait.h>
#endif

namespace rt::test {
namespace {

namespace fs = std::filesystem;

#ifdef _WIN32

std::string quoted(const std::string& text) {
    return '"' + text + '"';
}
std::string assignment(const std::string& name, const std::string& value) {
    return "set \"" + name + "=" + value + "\" && ";
}
constexpr const char* kEnterFolder = "cd /d ";
int exitCodeOf(int status) {
    return status;
}

#else

std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}
std::string assignment(const std::string& name, const std::string& value) {
    return "export " + name + "=" + quoted(value) + " && ";
}
constexpr const char* kEnterFolder = "cd ";
int exitCodeOf(int status) {
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status); // no program ends by a signal
}

#endif

} // namespace

// Of all tests: what one program has compiled serves the next.
fs::path cacheFolder() {
    return fs::path(testing::TempDir()) / "ray-tracing-test-cache";
}

std::string programPath(const std::string& program) {
    fs::path path = fs::path(RT_PROGRAM_DIR) / program;
#ifdef _WIN32
    path += ".exe";
#endif
    return path.string();
}

void ProgramTest::SetUp() {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string(test.test_suite_name()) + "-" + test.name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
}

void ProgramTest::TearDown() {
    fs::remove_all(folder_);
}

std::string ProgramTest::bytesOf(const std::string& name) const {
    return bytesOfFile(folder_ / name);
}

void ProgramTest::writeFile(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
}

Outcome ProgramTest::run(const std::string& program, const Arguments& arguments, const Environment& environment) const {
    // Beside the folder, so that tests see only what the program writes there.
    const std::string out = folder_.string() + ".out";
    const std::string err = folder_.string() + ".err";
    std::string command =
        kEnterFolder + quoted(folder_.string()) + " && " + assignment("XDG_CONFIG_HOME", (folder_ / "config").string());
    command += assignment("XDG_CACHE_HOME", cacheFolder().string());
    command += assignment("XDG_STATE_HOME", (folder_ / "state").string());
    command += assignment("RT_PLANET_MAPS", ""); // the generated ones, wherever tests run
    // No window opens by mistake.
    command += assignment("DISPLAY", "") + assignment("WAYLAND_DISPLAY", "");
    for (const auto& [name, value] : environment) command += assignment(name, value);
    if (addressSpace_ > 0) command += "ulimit -v " + std::to_string(addressSpace_) + " && ";
    command += quoted(programPath(program));
    for (const std::string& argument : arguments) command += " " + quoted(argument);
    command += " > " + quoted(out) + " 2> " + quoted(err);
    Outcome outcome;
    outcome.exitCode = exitCodeOf(std::system(command.c_str()));
    outcome.out = bytesOfFile(out);
    outcome.err = bytesOfFile(err);
    fs::remove(out);
    fs::remove(err);
    return outcome;
}

Outcome ProgramTest::render(const Arguments& arguments, const Environment& environment) const {
    Arguments all = {"-q", "--headless", "--width", "32", "--height", "32", "--spp", "4"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return cpu(all, environment);
}

std::string ProgramTest::pixels(const Arguments& arguments) const {
    Arguments all = arguments;
    all.insert(all.end(), {"-o", "pixels.pfm"});
    const Outcome outcome = render(all);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    std::string bytes = bytesOf("pixels.pfm");
    EXPECT_FALSE(bytes.empty());
    fs::remove(folder_ / "pixels.pfm");
    return bytes;
}

testing::AssertionResult failsWith(const Outcome& outcome, int exitCode, const std::string& mentioning) {
    const bool oneLine = std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1 && outcome.err.back() == '\n';
    if (outcome.exitCode == exitCode && oneLine && outcome.err.rfind("ray-tracing-", 0) == 0 && outcome.out.empty() &&
        outcome.err.find(mentioning) != std::string::npos)
        return testing::AssertionSuccess();
    return testing::AssertionFailure() << "expected exit code " << exitCode << " and one line with \"" << mentioning
                                       << "\", got " << outcome.exitCode << " and:\n"
                                       << outcome.err << outcome.out;
}

} // namespace rt::test
