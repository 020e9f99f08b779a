// What a file browser lists.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace rt::app {

struct FolderEntry {
    std::string name;
    bool isFolder = false;
};

struct FolderList {
    static constexpr std::size_t kMax = 2000; // entries: more are left out, and `isCut` says so

    std::vector<FolderEntry> entries; // folders first, by name whatever the case
    bool isCut = false;
    std::string failure; // why the folder cannot be read; empty: it can
};

// Folders, and files that have one of the extensions (".json", in small letters; none: all files). What is hidden is
// left out. Does not throw.
FolderList listFolder(const std::filesystem::path& folder, const std::vector<std::string>& extensions);

} // namespace rt::app
