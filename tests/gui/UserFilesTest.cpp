#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Options/Options.h"
#include "Common/Gui/UserFiles.h"
#include "tests/Environment.h"
#include "tests/TempFolder.h"

namespace rt::gui {
namespace {

using app::Tonemap;

class UserFilesTest : public testing::Test {
  protected:
    void SetUp() override { test::setVariable("XDG_CONFIG_HOME", folder_.path().string()); }
    void TearDown() override { test::setVariable("XDG_CONFIG_HOME", ""); }

    // Of a window that is opened with these arguments.
    static app::Options options(std::vector<std::string> arguments) {
        arguments.emplace_back("--window");
        return app::parseOptions("ray-tracing-cpu", std::move(arguments), std::cout).value();
    }

    test::TempFolder folder_;
};

TEST_F(UserFilesTest, TheLookOfFilesOfTheCommandLineIsForgotten) {
    {
        KeptSettings kept(options({"-o", "a.png"}));
        EXPECT_EQ(kept.settings.tonemap, Tonemap::None);
        kept.settings.uiScale = 1.5f;
        kept.store();
    }
    KeptSettings kept(options({}));
    EXPECT_EQ(kept.settings.tonemap, Tonemap::Neutral);
    EXPECT_EQ(kept.settings.uiScale, 1.5f);
}

TEST_F(UserFilesTest, TheLookThatTheUserChoosesIsKept) {
    {
        KeptSettings kept(options({"-o", "a.png"}));
        kept.settings.tonemap = Tonemap::Aces;
        kept.store();
        kept.settings.tonemap = Tonemap::None; // as it was, but chosen now
        kept.settings.exposure = 2;
        kept.store();
    }
    KeptSettings kept(options({}));
    EXPECT_EQ(kept.settings.tonemap, Tonemap::None);
    EXPECT_EQ(kept.settings.exposure, 2);
}

} // namespace
} // namespace rt::gui
