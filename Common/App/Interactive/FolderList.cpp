#include "Common/App/Interactive/FolderList.h"

#include <algorithm>
#include <cctype>
#include <tuple>

namespace rt::app {
namespace {

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

} // namespace

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
            extensions.empty() ||
            std::find(extensions.begin(), extensions.end(), lower(at->path().extension().string())) != extensions.end();
        if (!isFolder && !(isWanted && at->is_regular_file(none))) continue;
        if ((list.isCut = list.entries.size() == FolderList::kMax)) break;
        list.entries.push_back({name, isFolder});
    }
    if (failure) list.failure = folder.string() + ": " + failure.message();
    std::sort(list.entries.begin(), list.entries.end(), [](const FolderEntry& a, const FolderEntry& b) {
        return std::tuple(!a.isFolder, lower(a.name), a.name) < std::tuple(!b.isFolder, lower(b.name), b.name);
    });
    return list;
}

} // namespace rt::app
