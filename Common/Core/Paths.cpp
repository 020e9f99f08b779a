#include "Common/Core/Paths.h"

#include <cstdlib>
#include <initializer_list>
#include <sstream>
#include <string>
#include <vector>

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

fs::path library; // see findAssetsAround()

// Where it may be from a program or a library: build/bin/program -> Assets beside build; prefix/bin/program and
// prefix/lib/python3/dist-packages/package/library -> prefix/share/ray-tracing-twins.
void addPlacesAround(const fs::path& file, std::vector<fs::path>& places) {
    constexpr int kLevels = 5;
    fs::path folder = file.parent_path();
    for (int level = 0; level < kLevels && folder.has_relative_path(); ++level, folder = folder.parent_path()) {
        places.push_back(folder / "Assets");
        places.push_back(folder / "share" / "ray-tracing-twins");
    }
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
    if (!library.empty()) addPlacesAround(library, candidates);
    addPlacesAround(executablePath(), candidates);
    std::vector<fs::path> found;
    std::error_code ignored;
    for (const fs::path& candidate : candidates)
        if (fs::is_directory(candidate, ignored)) found.push_back(candidate);
    return found;
}

void findAssetsAround(const fs::path& file) {
    library = file;
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
