#include "tests/gui/Desktop.h"

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "tests/FileBytes.h"
#include "tests/gui/XClient.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

// Runs a command and returns what it writes.
std::string output(const std::string& command) {
    std::string text;
    FILE* pipe = popen((command + " 2>/dev/null").c_str(), "r");
    if (pipe == nullptr) return text;
    std::array<char, 256> buffer{};
    while (fgets(buffer.data(), buffer.size(), pipe) != nullptr) text += buffer.data();
    pclose(pipe);
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    return text;
}

// A process with this environment and its messages in a file.
int spawn(const std::vector<std::string>& arguments,
          const std::vector<std::pair<std::string, std::string>>& environment, const fs::path& log) {
    const int process = fork();
    if (process != 0) return process;
    for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
    unsetenv("WAYLAND_DISPLAY");
    const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(file, 1);
    dup2(file, 2);
    std::vector<char*> pointers;
    pointers.reserve(arguments.size() + 1);
    for (const std::string& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
    pointers.push_back(nullptr);
    execvp(pointers[0], pointers.data());
    _exit(127);
}

// Of a process or a thread, from its folder of /proc.
std::pair<char, int> stateAndParent(const fs::path& folder) {
    // "pid (name) state parent ...": the name may hold anything.
    const std::string stat = bytesOfFile(folder / "stat");
    const std::size_t end = stat.rfind(')');
    std::pair<char, int> found{};
    if (end != std::string::npos) std::istringstream(stat.substr(end + 1)) >> found.first >> found.second;
    return found;
}

// An exit code, or 128 and the signal's number.
int waitFor(int process) {
    int status = 0;
    waitpid(process, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

} // namespace

void Desktop::SetUp() {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(test.test_suite_name()) + "-" + test.name();
    for (char& c : name)
        if (c == '/') c = '-';
    folder_ = fs::path(testing::TempDir()) / name;
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "pictures");
    const std::string screen = std::to_string(kWidth) + "x" + std::to_string(kHeight) + "x24";
    // The server chooses a free number and says which. A pointer would be seen on the screenshots.
    const std::string folder = folder_.string();
    screen_ = spawn({"Xvfb", "-displayfd", "1", "-screen", "0", screen, "-fbdir", folder, "-nocursor", "-nolisten",
                     "tcp", "-noreset"},
                    {}, folder_ / "screen.log");
    ASSERT_TRUE(eventually([this] {
        std::istringstream lines(bytesOfFile(folder_ / "screen.log"));
        int number = -1;
        for (std::string line; std::getline(lines, line);)
            if (!line.empty() && line.find_first_not_of("0123456789") == std::string::npos) number = std::stoi(line);
        display_ = ":" + std::to_string(number);
        return number >= 0;
    })) << "Xvfb does not start; Debian, Ubuntu: apt install xvfb xdotool\n"
        << bytesOfFile(folder_ / "screen.log");
    framebuffer_ = std::make_unique<Framebuffer>(display_, folder_);
}

void Desktop::TearDown() {
    if (program_ > 0) {
        kill(program_, SIGKILL);
        waitFor(program_);
    }
    endScreen();
    if (!HasFailure()) fs::remove_all(folder_);
}

void Desktop::launch(const std::string& program, const std::vector<std::string>& arguments) {
    std::vector<std::string> all = {
        std::string(RT_PROGRAM_DIR) + "/" + program, "--validation", "--width", "48", "--spp", "4"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    std::vector<std::pair<std::string, std::string>> environment = {
        {"DISPLAY", display_},
        {"XDG_CONFIG_HOME", (folder_ / "config").string()},
        {"XDG_STATE_HOME", (folder_ / "state").string()},
        {"RT_PLANET_MAPS", ""},                // the generated ones, wherever tests run
        {"XDG_RUNTIME_DIR", folder_.string()}, // newer drivers complain where there is none
        {"XDG_PICTURES_DIR", (folder_ / "pictures").string()}};
    environment.insert(environment.end(), environment_.begin(), environment_.end());
    program_ = spawn(all, environment, folder_ / "program.log");
}

void Desktop::start(const std::string& program, const std::vector<std::string>& arguments) {
    launch(program, arguments);
    window_.clear();
    ASSERT_TRUE(eventually([&] { return !isRunning() || isVisible(); }));
    ASSERT_FALSE(window_.empty()) << log();
    // The scene is there when the title names it.
    ASSERT_TRUE(eventually([&] { return !isRunning() || title().find(" - ") != std::string::npos; }));
    ASSERT_TRUE(isRunning()) << log();
    act("mousemove " + std::to_string(kWidth - 200) + " 300"); // keys go to the window under the pointer
}

bool Desktop::isVisible() {
    window_ = output("DISPLAY=" + display_ + " xdotool search --onlyvisible --pid " + std::to_string(program_));
    return !window_.empty();
}

bool Desktop::isRunning() {
    if (program_ <= 0) return false;
    int status = 0;
    if (waitpid(program_, &status, WNOHANG) == 0) return true;
    program_ = -1;
    return false;
}

int Desktop::quit() {
    if (!isRunning()) return -1;
    key("Escape");
    key("ctrl+q");
    return waitForEnd();
}

int Desktop::endBySignal(int signal) {
    if (!isRunning()) return -1;
    kill(program_, signal);
    return waitForEnd();
}

int Desktop::waitForEnd() {
    const int process = program_;
    int status = 0;
    const bool ended = eventually([&] { return waitpid(process, &status, WNOHANG) != 0; });
    if (!ended) return -2;
    program_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string Desktop::log() const {
    return bytesOfFile(folder_ / "program.log");
}

void Desktop::act(const std::string& commands) {
    output("DISPLAY=" + display_ + " xdotool " + commands);
}

void Desktop::type(const std::string& text) {
    act("type --delay 5 '" + text + "'");
}

std::string Desktop::title() {
    return windowTitle(display_, std::stoul(window_));
}

void Desktop::resize(int width, int height) {
    act("windowsize " + window_ + " " + std::to_string(width) + " " + std::to_string(height));
}

void Desktop::minimise(bool minimised) {
    setMinimised(display_, std::stoul(window_), minimised);
}

void Desktop::freeze(bool frozen) {
    kill(program_, frozen ? SIGSTOP : SIGCONT);
}

void Desktop::setDotsPerInch(int dots) {
    test::setDotsPerInch(display_, dots);
}

void Desktop::paintOver(unsigned side, std::uint32_t color) {
    test::paintOver(display_, std::stoul(window_), side, color);
}

void Desktop::expose() {
    test::exposeWindow(display_, std::stoul(window_));
}

void Desktop::destroyWindow() {
    test::destroyWindow(display_, std::stoul(window_));
}

void Desktop::endScreen() {
    if (screen_ <= 0) return;
    framebuffer_.reset();
    kill(screen_, SIGTERM);
    waitFor(screen_);
    screen_ = -1;
}

bool Desktop::drop(const std::vector<std::string>& files, int x, int y) {
    return dropFiles(display_, std::stoul(window_), files, x, y);
}

std::uint64_t Desktop::residentBytes() const {
    std::ifstream statm("/proc/" + std::to_string(program_) + "/statm");
    std::uint64_t total = 0, resident = 0;
    statm >> total >> resident;
    return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

bool Desktop::isBusy() const {
    std::error_code none;
    const fs::path threads = fs::path("/proc") / std::to_string(program_) / "task";
    for (const fs::directory_entry& thread : fs::directory_iterator(threads, none)) {
        const char state = stateAndParent(thread.path()).first;
        if (state == 'R' || state == 'D') return true;
    }
    return false;
}

bool Desktop::hasChild() const {
    std::error_code none;
    for (const fs::directory_entry& process : fs::directory_iterator("/proc", none)) {
        const auto [state, parent] = stateAndParent(process.path());
        if (parent == program_ && state != 'Z') return true;
    }
    return false;
}

bool Desktop::eventually(const std::function<bool()>& condition, std::chrono::milliseconds patience) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (std::chrono::steady_clock::now() < end) {
        if (condition()) return true;
        pause(50);
    }
    return condition();
}

void Desktop::pause(int milliseconds) {
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

} // namespace rt::test
