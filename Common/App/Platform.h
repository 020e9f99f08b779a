// The few questions that each operating system answers in its own way.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rt::app {

std::uint64_t peakResidentBytes(); // of this process; 0 where unknown
bool standardErrorIsTerminal();
bool hasDisplay(); // false where a window cannot be opened for want of a screen; true where only trying tells
// $XDG_CONFIG_HOME/ray-tracing or the platform's place for it; empty when the environment names none.
std::filesystem::path userConfigDirectory();
std::uint64_t residentBytes();  // of this process at present; 0 where unknown
std::uint64_t machineBytes();   // of memory that it has; 0 where unknown
std::uint32_t processorCount(); // of the machine, whichever of them this process may use
double processorSeconds();      // that all threads of this process have run
std::uint64_t processId();      // as the system's list of processes has it

// The calling thread, and where the platform lets them inherit it the threads that it starts, give way to others.
void lowerThreadPriority();

// A library that is not linked and may be missing; loaded from the system's places, in
// Windows also from the program's folder, while this exists.
class SharedLibrary {
  public:
    explicit SharedLibrary(std::initializer_list<const char*> names); // the first of these that is there
    ~SharedLibrary();
    SharedLibrary(const SharedLibrary&) = delete;
    SharedLibrary& operator=(const SharedLibrary&) = delete;

    template <class Function>
    Function* find(const char* name) const { // null: there is no such library, or it has no such function
        return reinterpret_cast<Function*>(symbol(name));
    }

  private:
    void* symbol(const char* name) const;
    void* handle_ = nullptr;
};

// Keeps other processes that lock the same file waiting while it exists. The file is made if need be. Throws
// RenderError.
class FileLock {
  public:
    explicit FileLock(const std::filesystem::path& file);
    // Null where another one has it, be it of this process. Throws RenderError.
    static std::unique_ptr<FileLock> ifFree(const std::filesystem::path& file);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

  private:
    FileLock(const std::filesystem::path& file, bool waits); // without waiting it may have no lock: handle_ is -1
    std::intptr_t handle_ = -1;
};

// A program that runs beside this one, without input, its output and messages in a file. The destructor ends it.
class ChildProcess {
  public:
    // Throws RenderError where it cannot be started.
    ChildProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                 const std::filesystem::path& log);
    ~ChildProcess() { end(); }
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    // None while it runs; 128 and the signal's number where a signal has ended it.
    std::optional<int> exitCode();
    void end(); // at once: it has no time to clean up

  private:
    std::intptr_t handle_ = 0;
    std::optional<int> exitCode_;
};

// While it exists: when the window system ends or takes the window away, whereupon its library would end the program,
// `rescue` is called, which must leave the window system alone, and the program ends with exit code 1. One at a time;
// to be made when there is a window.
class WindowLossGuard {
  public:
    explicit WindowLossGuard(std::function<void()> rescue);
    ~WindowLossGuard();
    WindowLossGuard(const WindowLossGuard&) = delete;
    WindowLossGuard& operator=(const WindowLossGuard&) = delete;
};

} // namespace rt::app
