#include "Common/App/Interactive/FolderList.h"

#include <algorithm>
#include <tuple>

#include "Common/Core/TextSearch.h"

namespace rt::app {

FolderList listFolder(const std::filesystem::path& folder, const std::vector<std::string>& extensions) {
    namespace fs = std::filesystem;
    FolderList list;
    std::error_code failure;
    for (fs::directory_iterator at(folder, failure); !failure && at != fs::directory_iterator();
         at.increment(failure)) {
        const std::string name = at->path().filename().string();
        if (name.front() == '.') continue;
        std::error_code none; // of what cannot be looked at: it is left out
        const bool isFolder = at->is_directory(none);
        const bool isWanted =
            extensions.empty() || std::find(extensions.begin(), extensions.end(),
                                            lowerCase(at->path().extension().string())) != extensions.end();
        if (!isFolder && !(isWanted && at->is_regular_file(none))) continue;
        if ((list.isCut = list.entries.size() == FolderList::kMax)) break;
        list.entries.push_back({name, isFolder});
    }
    if (failure) list.failure = folder.string() + ": " + failure.message();
    std::sort(list.entries.begin(), list.entries.end(), [](const FolderEntry& a, const FolderEntry& b) {
        return std::tuple(!a.isFolder, lowerCase(a.name), a.name) < std::tuple(!b.isFolder, lowerCase(b.name), b.name);
    });
    return list;
}

} // namespace rt::app
