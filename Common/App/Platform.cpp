#include "Common/App/Platform.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <system_error>
#include <utility>

#ifdef _WIN32
#include <io.h>
#include <windows.h>
// After windows.h:
#include <psapi.h>
#else
#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#endif
#ifdef __linux__
#include <sys/syscall.h>
#endif

#include "Common/Core/Error.h"

#ifndef _WIN32
extern char** environ; // POSIX names it, and leaves its declaration to the program
#endif

namespace rt::app {

#ifdef _WIN32

std::uint64_t peakResidentBytes() {
    PROCESS_MEMORY_COUNTERS counters{};
    return GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof counters) ? counters.PeakWorkingSetSize : 0;
}

bool standardErrorIsTerminal() {
    return _isatty(2) != 0;
}

bool hasDisplay() {
    return true;
}

std::uint64_t residentBytes() {
    PROCESS_MEMORY_COUNTERS counters{};
    return GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof counters) ? counters.WorkingSetSize : 0;
}

std::uint64_t machineBytes() {
    MEMORYSTATUSEX memory{};
    memory.dwLength = sizeof memory;
    return GlobalMemoryStatusEx(&memory) ? memory.ullTotalPhys : 0;
}

std::uint32_t processorCount() {
    return std::max<std::uint32_t>(1, GetActiveProcessorCount(ALL_PROCESSOR_GROUPS));
}

double processorSeconds() {
    FILETIME created{}, ended{}, kernel{}, user{};
    if (!GetProcessTimes(GetCurrentProcess(), &created, &ended, &kernel, &user)) return 0;
    const auto seconds = [](const FILETIME& time) {
        return 1e-7 * static_cast<double>(std::uint64_t{time.dwHighDateTime} << 32 | time.dwLowDateTime);
    };
    return seconds(kernel) + seconds(user);
}

std::uint64_t processId() {
    return GetCurrentProcessId();
}

void lowerThreadPriority() {
    SetThreadPriority(GetCurrentThread(), THREAD_PRIORITY_BELOW_NORMAL);
}

SharedLibrary::SharedLibrary(std::initializer_list<const char*> names) {
    constexpr DWORD kSearched = LOAD_LIBRARY_SEARCH_SYSTEM32 | LOAD_LIBRARY_SEARCH_APPLICATION_DIR;
    for (const char* name : names)
        if (handle_ == nullptr) handle_ = LoadLibraryExA(name, nullptr, kSearched);
}

SharedLibrary::~SharedLibrary() {
    if (handle_ != nullptr) FreeLibrary(static_cast<HMODULE>(handle_));
}

void* SharedLibrary::symbol(const char* name) const {
    return handle_ == nullptr ? nullptr : reinterpret_cast<void*>(GetProcAddress(static_cast<HMODULE>(handle_), name));
}

FileLock::FileLock(const std::filesystem::path& file, bool waits) {
    const HANDLE handle = CreateFileW(file.c_str(), GENERIC_READ | GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE,
                                      nullptr, OPEN_ALWAYS, FILE_ATTRIBUTE_NORMAL, nullptr);
    if (handle == INVALID_HANDLE_VALUE) throw RenderError(file.string() + ": cannot be opened");
    OVERLAPPED start{};
    const DWORD how = LOCKFILE_EXCLUSIVE_LOCK | (waits ? 0 : LOCKFILE_FAIL_IMMEDIATELY);
    if (LockFileEx(handle, how, 0, MAXDWORD, MAXDWORD, &start)) {
        handle_ = reinterpret_cast<std::intptr_t>(handle);
        return;
    }
    const bool isTaken = GetLastError() == ERROR_LOCK_VIOLATION;
    CloseHandle(handle);
    if (waits || !isTaken) throw RenderError(file.string() + ": cannot be locked");
}

FileLock::~FileLock() {
    if (handle_ != -1) CloseHandle(reinterpret_cast<HANDLE>(handle_));
}

namespace {

// As the C runtime of the program that is started takes command lines apart: backslashes count before quotes only.
std::wstring quoted(const std::wstring& argument) {
    std::wstring text = L"\"";
    std::size_t backslashes = 0;
    for (const wchar_t c : argument) {
        if (c == L'"') text.append(backslashes + 1, L'\\');
        backslashes = c == L'\\' ? backslashes + 1 : 0;
        text += c;
    }
    return text.append(backslashes, L'\\') + L"\"";
}

} // namespace

ChildProcess::ChildProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                           const std::filesystem::path& log) {
    std::wstring line = quoted(program.wstring());
    for (const std::string& argument : arguments) line += L" " + quoted(std::filesystem::path(argument).wstring());
    SECURITY_ATTRIBUTES inherited{sizeof inherited, nullptr, TRUE};
    const HANDLE output = CreateFileW(log.c_str(), GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE, &inherited,
                                      CREATE_ALWAYS, FILE_ATTRIBUTE_NORMAL, nullptr);
    if (output == INVALID_HANDLE_VALUE) throw RenderError(log.string() + ": cannot be opened");
    STARTUPINFOW start{};
    start.cb = sizeof start;
    start.dwFlags = STARTF_USESTDHANDLES;
    start.hStdOutput = start.hStdError = output;
    PROCESS_INFORMATION process{};
    const bool started = CreateProcessW(program.c_str(), line.data(), nullptr, nullptr, TRUE, CREATE_NO_WINDOW, nullptr,
                                        nullptr, &start, &process) != 0;
    CloseHandle(output);
    if (!started) throw RenderError(program.string() + ": cannot be started");
    CloseHandle(process.hThread);
    handle_ = reinterpret_cast<std::intptr_t>(process.hProcess);
}

std::optional<int> ChildProcess::exitCode() {
    const HANDLE process = reinterpret_cast<HANDLE>(handle_);
    if (exitCode_ || WaitForSingleObject(process, 0) != WAIT_OBJECT_0) return exitCode_;
    DWORD code = 0;
    GetExitCodeProcess(process, &code);
    CloseHandle(process);
    return exitCode_ = static_cast<int>(code);
}

void ChildProcess::end() {
    if (exitCode()) return;
    TerminateProcess(reinterpret_cast<HANDLE>(handle_), 1);
    WaitForSingleObject(reinterpret_cast<HANDLE>(handle_), INFINITE);
    exitCode();
}

#else

std::uint64_t peakResidentBytes() {
    rusage usage{};
    if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
#ifdef __APPLE__
    return static_cast<std::uint64_t>(usage.ru_maxrss);
#else
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024; // kibibytes
#endif
}

bool standardErrorIsTerminal() {
    return isatty(STDERR_FILENO) != 0;
}

bool hasDisplay() {
#ifndef __APPLE__
    for (const char* variable : {"DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"}) {
        const char* value = std::getenv(variable);
        if (value != nullptr && *value != '\0') return true;
    }
    return false;
#else
    return true;
#endif
}

std::uint64_t residentBytes() {
    std::ifstream statm("/proc/self/statm"); // Linux only; elsewhere it does not exist
    std::uint64_t total = 0, resident = 0;
    return statm >> total >> resident ? resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) : 0;
}

std::uint64_t machineBytes() {
    const long pages = sysconf(_SC_PHYS_PAGES), bytes = sysconf(_SC_PAGESIZE);
    return pages > 0 && bytes > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(bytes) : 0;
}

std::uint32_t processorCount() {
    const long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count > 0 ? static_cast<std::uint32_t>(count) : 1;
}

double processorSeconds() {
    rusage usage{};
    if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::uint64_t processId() {
    return static_cast<std::uint64_t>(getpid());
}

void lowerThreadPriority() {
#ifdef __linux__
    // Linux gives each thread a niceness of its own, and new threads that of the one that starts them.
    setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), 5);
#endif
}

SharedLibrary::SharedLibrary(std::initializer_list<const char*> names) {
    for (const char* name : names)
        if (handle_ == nullptr) handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
}

SharedLibrary::~SharedLibrary() {
    if (handle_ != nullptr) dlclose(handle_);
}

void* SharedLibrary::symbol(const char* name) const {
    return handle_ == nullptr ? nullptr : dlsym(handle_, name);
}

FileLock::FileLock(const std::filesystem::path& file, bool waits) {
    const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    const auto fail = [&file](const char* what) {
        throw RenderError(file.string() + ": " + what + ": " + std::generic_category().message(errno));
    };
    if (descriptor < 0) fail("cannot be opened");
    int result = 0;
    do result = flock(descriptor, waits ? LOCK_EX : LOCK_EX | LOCK_NB);
    while (result != 0 && errno == EINTR);
    if (result == 0) {
        handle_ = descriptor;
        return;
    }
    const int error = errno;
    close(descriptor);
    errno = error;
    if (waits || error != EWOULDBLOCK) fail("cannot be locked");
}

FileLock::~FileLock() {
    if (handle_ != -1) close(static_cast<int>(handle_));
}

ChildProcess::ChildProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                           const std::filesystem::path& log) {
    std::vector<std::string> words = {program.string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
    pid_t process = 0;
    const int error = posix_spawn(&process, program.c_str(), &files, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (error != 0)
        throw RenderError(program.string() + ": cannot be started: " + std::generic_category().message(error));
    handle_ = process;
}

std::optional<int> ChildProcess::exitCode() {
    if (exitCode_) return exitCode_;
    int status = 0;
    const pid_t ended = waitpid(static_cast<pid_t>(handle_), &status, WNOHANG);
    if (ended == 0 || (ended < 0 && errno == EINTR)) return std::nullopt;
    exitCode_ = ended < 0 ? 1 : WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return exitCode_;
}

void ChildProcess::end() {
    if (exitCode()) return;
    kill(static_cast<pid_t>(handle_), SIGKILL);
    int status = 0;
    while (waitpid(static_cast<pid_t>(handle_), &status, 0) < 0 && errno == EINTR) {
    }
    exitCode_ = 128 + SIGKILL;
}

#endif

FileLock::FileLock(const std::filesystem::path& file) : FileLock(file, true) {}

std::unique_ptr<FileLock> FileLock::ifFree(const std::filesystem::path& file) {
    std::unique_ptr<FileLock> lock(new FileLock(file, false));
    if (lock->handle_ == -1) lock.reset();
    return lock;
}

#ifdef __linux__

namespace {

std::function<void()> rescueFromLoss;

// Xlib would go on to exit(), which takes libraries apart that other threads are still in.
[[noreturn]] void rescueAndEnd() {
    if (const auto rescue = std::exchange(rescueFromLoss, nullptr)) rescue();
    std::_Exit(static_cast<int>(ExitCode::Failure));
}
int onConnectionLoss(void*) {
    rescueAndEnd();
}
int onError(void*, void*) { // of requests to a window that is gone
    rescueAndEnd();
}

// In the Xlib that the window library has loaded, where there is one.
template <class Handler>
void setHandler(const char* setter, Handler* handler) {
    const SharedLibrary xlib{"libX11.so.6"};
    if (auto* const set = xlib.find<Handler*(Handler*)>(setter)) set(handler);
}

} // namespace

WindowLossGuard::WindowLossGuard(std::function<void()> rescue) {
    rescueFromLoss = std::move(rescue);
    setHandler("XSetIOErrorHandler", onConnectionLoss);
    setHandler("XSetErrorHandler", onError);
}

WindowLossGuard::~WindowLossGuard() {
    setHandler<decltype(onConnectionLoss)>("XSetIOErrorHandler", nullptr);
    setHandler<decltype(onError)>("XSetErrorHandler", nullptr);
    rescueFromLoss = nullptr;
}

#else

WindowLossGuard::WindowLossGuard(std::function<void()>) {}
WindowLossGuard::~WindowLossGuard() = default;

#endif

std::filesystem::path userConfigDirectory() {
    const auto inside = [](const char* variable, const char* folder) {
        const char* base = std::getenv(variable);
        return base != nullptr && *base != '\0' ? std::filesystem::path(base) / folder : std::filesystem::path();
    };
    if (auto path = inside("XDG_CONFIG_HOME", "ray-tracing"); !path.empty()) return path;
#if defined(_WIN32)
    return inside("APPDATA", "ray-tracing");
#elif defined(__APPLE__)
    return inside("HOME", "Library/Application Support/ray-tracing");
#else
    return inside("HOME", ".config/ray-tracing");
#endif
}

} // namespace rt::app
