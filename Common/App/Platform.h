// The few questions that each operating system answers in its own way.
#pragma once
#include <cstdint>
#include <filesystem>

namespace rt::app {

std::uint64_t peakResidentBytes(); // of this process; 0 where unknown
bool standardErrorIsTerminal();
bool hasDisplay(); // false where a window cannot be opened for want of a screen; true where only trying tells
// $XDG_CONFIG_HOME/ray-tracing or the platform's place for it; empty when the environment names none.
std::filesystem::path userConfigDirectory();
std::uint64_t residentBytes(); // of this process at present; 0 where unknown

// The calling thread, and where the platform lets them inherit it the threads that it starts, give way to others.
void lowerThreadPriority();

// Keeps other processes that lock the same file waiting while it exists. The file is made if need be. Throws RenderError.
class FileLock {
  public:
    explicit FileLock(const std::filesystem::path& file);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

  private:
    std::intptr_t handle_;
};

} // namespace rt::app
