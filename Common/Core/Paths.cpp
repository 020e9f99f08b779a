#include "Common/Core/Paths.h"

#include <cstdlib>
#include <initializer_list>
#include <sstream>
#include <string>

namespace rt {

namespace fs = std::filesystem;

namespace {

// A variable of the environment, and a folder below the one that it names.
struct Place {
    const char* variable;
    const char* folder;
};

// The first whose variable is set.
fs::path firstOf(std::initializer_list<Place> places) {
    for (const auto& [variable, folder] : places)
        if (const char* value = std::getenv(variable); value && *value) return fs::path(value) / folder;
    return {};
}

} // namespace

fs::path findProgram(const char* name) {
#if defined(_WIN32)
    constexpr char kSeparator = ';';
#else
    constexpr char kSeparator = ':';
#endif
    const char* folders = std::getenv("PATH");
    std::istringstream list(folders ? folders : "");
    for (std::string folder; std::getline(list, folder, kSeparator);) {
        fs::path program = fs::path(folder) / name;
        program += executablePath().extension();
        std::error_code ignored;
        if (!folder.empty() && fs::is_regular_file(program, ignored)) return program;
    }
    return {};
}

fs::path userCacheFolder() {
#if defined(_WIN32)
    return firstOf({{"LOCALAPPDATA", "ray-tracing/cache"}});
#elif defined(__APPLE__)
    return firstOf({{"XDG_CACHE_HOME", "ray-tracing"}, {"HOME", "Library/Caches/ray-tracing"}});
#else
    return firstOf({{"XDG_CACHE_HOME", "ray-tracing"}, {"HOME", ".cache/ray-tracing"}});
#endif
}

fs::path userStateFolder() {
#if defined(_WIN32)
    return firstOf({{"LOCALAPPDATA", "ray-tracing/state"}});
#elif defined(__APPLE__)
    return firstOf({{"XDG_STATE_HOME", "ray-tracing"}, {"HOME", "Library/Application Support/ray-tracing"}});
#else
    return firstOf({{"XDG_STATE_HOME", "ray-tracing"}, {"HOME", ".local/state/ray-tracing"}});
#endif
}

std::vector<fs::path> assetFolders() {
    std::vector<fs::path> candidates;
    if (const char* chosen = std::getenv("RT_ASSETS"); chosen && *chosen) candidates.emplace_back(chosen);
    // build/bin/program -> Assets beside build; prefix/bin/program -> prefix/share/ray-tracing-twins.
    fs::path folder = executablePath().parent_path();
    for (int level = 0; level < 4 && folder.has_relative_path(); ++level, folder = folder.parent_path()) {
        candidates.push_back(folder / "Assets");
        candidates.push_back(folder / "share" / "ray-tracing-twins");
    }
    std::vector<fs::path> found;
    std::error_code ignored;
    for (const fs::path& candidate : candidates)
        if (fs::is_directory(candidate, ignored)) found.push_back(candidate);
    return found;
}

fs::path planetMapFolder() {
    const char* chosen = std::getenv("RT_PLANET_MAPS");
    const fs::path folder = chosen != nullptr ? chosen : "/usr/share/xplanet/images";
    std::error_code ignored;
    return fs::is_directory(folder, ignored) ? folder : fs::path();
}

std::optional<fs::path> findAsset(const fs::path& name) {
    std::error_code ignored;
    for (const fs::path& folder : assetFolders())
        if (fs::is_regular_file(folder / name, ignored)) return folder / name;
    return std::nullopt;
}

} // namespace rt
