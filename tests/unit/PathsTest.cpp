#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "Common/Core/Paths.h"

namespace rt {
namespace {

namespace fs = std::filesystem;

TEST(Paths, TheProgramKnowsItsFile) {
    EXPECT_TRUE(fs::is_regular_file(executablePath()));
    EXPECT_NE(executablePath().filename().string().find("tests"), std::string::npos);
}

TEST(Paths, AssetsOfTheSourceTreeAreFoundFromAnyDirectory) {
    const fs::path before = fs::current_path();
    fs::current_path(fs::temp_directory_path());
    const auto found = findAsset("scene.schema.json");
    fs::current_path(before);
    ASSERT_TRUE(found);
    EXPECT_TRUE(fs::equivalent(*found, fs::path(RT_SOURCE_DIR) / "Assets" / "scene.schema.json"));
    EXPECT_FALSE(findAsset("no/such/asset"));
    EXPECT_FALSE(findAsset("scenes")) << "a folder is no asset";
    const auto folders = assetFolders();
    EXPECT_TRUE(std::all_of(folders.begin(), folders.end(), [](const fs::path& p) { return fs::is_directory(p); }));
}

} // namespace
} // namespace rt
