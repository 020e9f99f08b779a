// The panels at the side of both windows, and what there is to see of them.
#include <string>

#include <gtest/gtest.h>

#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

class PanelsTest : public WindowTest {
  protected:
    bool isGpu() const { return std::string(GetParam()) == "ray-tracing-gpu"; }
    int samplesRow() const { return isGpu() ? 410 : 381; }
    // A dot at the upper right of the row's label.
    bool areSamplesMarked() const {
        const Screenshot shot = screenshot();
        return shot.at(110, samplesRow() - 4) != shot.at(130, samplesRow() - 4);
    }
    void click(int x, int y) {
        act("mousemove " + std::to_string(x) + " " + std::to_string(y) +
            " sleep 0.3 mousedown 1 sleep 0.2 mouseup 1 sleep 0.3");
    }
};
INSTANTIATE_TEST_SUITE_P(, PanelsTest, kBothPrograms, nameOfProgram);

// One thread cannot be divided, rasterised pictures have no samples: their rows stay, and so do those below.
TEST_P(PanelsTest, ChangedSettingsAreMarkedAndRestoredAndDisabledRowsStayInPlace) {
    start({"--width", "32", "--spp", "7", "--engine", isGpu() ? "compute" : "single"});
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_TRUE(eventually([&] { return areSamplesMarked(); }));
    if (isGpu()) {
        key("p");
        EXPECT_TRUE(eventually([&] { return settings()["ray_tracing"] == false; })) << settings();
        EXPECT_TRUE(areSamplesMarked());
    }
    click(75, samplesRow() + 253); // Restore defaults
    EXPECT_TRUE(eventually([&] { return settings()["render"]["spp"] == 100; })) << settings();
    EXPECT_TRUE(eventually([&] { return !areSamplesMarked(); }));
    EXPECT_EQ(settings()["render"]["width"], nlohmann::json()) << settings();
    expectCleanEnd();
}

TEST_P(PanelsTest, TheSceneBrowserFindsByName) {
    start({"--width", "32", "--spp", "1"});
    ASSERT_FALSE(HasFatalFailure());
    const scene::BuiltinScene& wanted = scene::builtinScenes().back();
    click(200, 181); // the scene's button
    pause(700);
    type(std::string(wanted.id));
    pause(300);
    key("Return");
    EXPECT_TRUE(eventually([&] { return title().find(wanted.title) == 0; })) << title() << log();
    click(200, 181);
    pause(700);
    type("no such scene");
    key("Return"); // nothing to open
    pause(500);
    EXPECT_EQ(title().find(wanted.title), 0u);
    expectCleanEnd();
}

} // namespace
} // namespace rt::test
