#include "Common/Core/Paths.h"

#include <cstdlib>

namespace rt {

namespace fs = std::filesystem;

fs::path userCacheFolder() {
#if defined(_WIN32)
    constexpr const char* kVariables[][2] = {{"LOCALAPPDATA", "ray-tracing/cache"}};
#elif defined(__APPLE__)
    constexpr const char* kVariables[][2] = {{"XDG_CACHE_HOME", "ray-tracing"}, {"HOME", "Library/Caches/ray-tracing"}};
#else
    constexpr const char* kVariables[][2] = {{"XDG_CACHE_HOME", "ray-tracing"}, {"HOME", ".cache/ray-tracing"}};
#endif
    for (const auto& [variable, folder] : kVariables)
        if (const char* value = std::getenv(variable); value && *value) return fs::path(value) / folder;
    return {};
}

std::vector<fs::path> assetFolders() {
    std::vector<fs::path> candidates;
    if (const char* chosen = std::getenv("RT_ASSETS"); chosen && *chosen) candidates.emplace_back(chosen);
    // build/bin/program -> Assets beside build; prefix/bin/program -> prefix/share/ray-tracing.
    fs::path folder = executablePath().parent_path();
    for (int level = 0; level < 4 && folder.has_relative_path(); ++level, folder = folder.parent_path()) {
        candidates.push_back(folder / "Assets");
        candidates.push_back(folder / "share" / "ray-tracing");
    }
    std::vector<fs::path> found;
    std::error_code ignored;
    for (const fs::path& candidate : candidates)
        if (fs::is_directory(candidate, ignored)) found.push_back(candidate);
    return found;
}

std::optional<fs::path> findAsset(const fs::path& name) {
    std::error_code ignored;
    for (const fs::path& folder : assetFolders())
        if (fs::is_regular_file(folder / name, ignored)) return folder / name;
    return std::nullopt;
}

} // namespace rt
