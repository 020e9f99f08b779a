#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Interactive/FolderList.h"
#include "tests/TempFolder.h"

namespace rt::app {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> namesOf(const FolderList& list) {
    std::vector<std::string> names;
    for (const FolderEntry& entry : list.entries) names.push_back(entry.name + (entry.isFolder ? "/" : ""));
    return names;
}

TEST(FolderList, FoldersComeFirstAndFilesAreFiltered) {
    const test::TempFolder folder;
    fs::create_directory(folder.path() / "zebra");
    fs::create_directory(folder.path() / ".hidden");
    for (const char* name : {"b.json", "A.JSON", "c.txt", ".d.json", "e"}) std::ofstream(folder.path() / name) << "x";
    EXPECT_EQ(namesOf(listFolder(folder.path(), {".json", ".obj"})),
              (std::vector<std::string>{"zebra/", "A.JSON", "b.json"}));
    EXPECT_EQ(namesOf(listFolder(folder.path(), {})),
              (std::vector<std::string>{"zebra/", "A.JSON", "b.json", "c.txt", "e"}));
}

TEST(FolderList, WhatCannotBeReadIsTold) {
    const test::TempFolder folder;
    const FolderList list = listFolder(folder.path() / "none", {});
    EXPECT_TRUE(list.entries.empty());
    EXPECT_NE(list.failure.find("none: "), std::string::npos);
}

TEST(FolderList, AFolderOfManyIsCut) {
    const test::TempFolder folder;
    for (std::size_t i = 0; i < FolderList::kMax; ++i) std::ofstream(folder.path() / std::to_string(i));
    EXPECT_FALSE(listFolder(folder.path(), {}).isCut);
    const std::ofstream more(folder.path() / "one-more");
    const FolderList list = listFolder(folder.path(), {});
    EXPECT_TRUE(list.isCut);
    EXPECT_EQ(list.entries.size(), FolderList::kMax);
}

} // namespace
} // namespace rt::app
