// Files that a scene names in other case.
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Core/OtherCase.h"
#include "Common/Scene/Builtin/Placeholders.h"
#include "tests/TempFolder.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

TEST(OtherCase, FindsWhatDiffersInCaseAlone) {
    const TempFolder folder;
    fs::create_directories(folder / "Textures");
    std::ofstream(folder / "Textures/Wood.PNG") << "x";
    const fs::path found = folder / "Textures/Wood.PNG";
    const fs::path other = findInOtherCase(folder / "textures/wood.png");
    ASSERT_FALSE(other.empty());
    EXPECT_TRUE(fs::equivalent(other, found));
    EXPECT_EQ(findInOtherCase(folder / "textures/wool.png"), fs::path());
    EXPECT_EQ(findInOtherCase(folder / "textures"), fs::path()) << "a folder";
    EXPECT_EQ(findInOtherCase("textures/wood.png"), fs::path()) << "relative";
}

TEST(OtherCase, ScenesAreReadWithANotice) {
    const TempFolder folder;
    std::ofstream(folder / "Wood.PNG") << "x";
    const std::string named = (folder / "wood.png").generic_string();
    std::error_code ignored;
    if (fs::exists(named, ignored)) GTEST_SKIP() << "this system takes no notice of case";
    std::vector<std::string> notices;
    const auto path = scene::locateAsset(named, "", {}, "a", notices);
    ASSERT_TRUE(path);
    EXPECT_EQ(path->filename(), "Wood.PNG");
    ASSERT_EQ(notices.size(), 1u);
    EXPECT_NE(notices[0].find("wood.png: there is no such file; read: Wood.PNG"), std::string::npos) << notices[0];
    EXPECT_THROW(scene::locateAsset((folder / "wool.png").generic_string(), "", {}, "a", notices), InputError);
}

} // namespace
} // namespace rt::test
