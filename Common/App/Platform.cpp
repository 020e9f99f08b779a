#include "Common/App/Platform.h"

#include <cstdlib>
#include <string>

#ifdef _WIN32
#include <io.h>
#include <windows.h>
// After windows.h:
#include <psapi.h>
#else
#include <sys/resource.h>
#include <unistd.h>
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
