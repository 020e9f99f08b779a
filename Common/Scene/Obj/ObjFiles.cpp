#include "Common/Scene/Obj/ObjFiles.h"

#include <algorithm>
#include <system_error>
#include <vector>

#include "Common/Core/ReadFile.h"
#include "Common/Scene/Obj/ObjText.h"

namespace rt::scene {

namespace {

namespace fs = std::filesystem;

fs::path portable(std::string_view name) {
    std::string path(name);
    std::replace(path.begin(), path.end(), '\\', '/');
    return path;
}

// What a file may be called that is named so, the likeliest first.
std::vector<fs::path> meanings(std::string_view name) {
    const std::string_view bare = withoutComment(name);
    std::vector<fs::path> paths;
    for (const std::string_view meaning : {name, withoutQuotes(name), bare, withoutQuotes(bare)})
        if (const fs::path path = portable(trimmed(meaning)); !path.empty() && std::ranges::count(paths, path) == 0)
            paths.push_back(path);
    return paths;
}

} // namespace

fs::path FileFinder::find(std::string_view name, const fs::path& folder) {
    const std::vector<fs::path> paths = meanings(name);
    for (const fs::path& path : paths)
        if (isFile(folder / path)) return folder / path;
    for (const fs::path& path : paths)
        if (fs::path found = findInOtherCase(path, folder); !found.empty()) {
            inOtherCase_.insert(path.generic_string());
            return found;
        }
    return {};
}

fs::path FileFinder::findMoved(std::string_view name, const fs::path& folder) {
    if (fs::path path = find(name, folder); !path.empty()) return path;
    for (const fs::path& path : meanings(name))
        if (fs::path moved = find(path.filename().string(), folder); !moved.empty()) return moved;
    return {};
}

const FileFinder::Listing& FileFinder::listing(const fs::path& folder) {
    const auto [entry, isNew] = listings_.try_emplace(folder);
    if (!isNew) return entry->second;
    std::error_code error;
    fs::directory_iterator file(folder.empty() ? fs::path(".") : folder, error);
    for (; !error && file != fs::directory_iterator(); file.increment(error)) {
        const std::string name = file->path().filename().string();
        std::string& known = entry->second.try_emplace(lowerCase(name), name).first->second;
        known = std::min(known, name); // whatever order the folder has
    }
    return entry->second;
}

fs::path FileFinder::findInOtherCase(const fs::path& name, const fs::path& folder) {
    if (name.is_absolute() || name.has_root_path()) return {};
    fs::path path = folder;
    for (const fs::path& part : name) {
        std::error_code ignored;
        if (fs::exists(path / part, ignored)) {
            path /= part;
            continue;
        }
        const Listing& names = listing(path);
        const auto found = names.find(lowerCase(part.string()));
        if (found == names.end()) return {};
        path /= found->second;
    }
    return isFile(path) ? path : fs::path();
}

} // namespace rt::scene
