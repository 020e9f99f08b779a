// Files that become a part of the scene by way of a window: models, images as sky and as textures.
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "Common/Image/ImageIo.h"
#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class AddedFilesTest : public WindowTest {
  protected:
    static constexpr int kBallX = 826, kBallY = 470, kSkyX = 1200, kSkyY = 200; // of the screen

    // Of the panels only that of the objects is folded out.
    void startWithBall() {
        std::ofstream(folder_ / "flag.mtl") << "newmtl red\nKd 1 0 0\n";
        std::ofstream(folder_ / "flag.obj") << "mtllib flag.mtl\nv 90 0 0\nv 91 0 0\nv 90 1 0\nusemtl red\nf 1 2 3\n";
        std::ofstream(folder_ / "bad.obj") << "v 0 0 x\nf 1 2 3\n";
        image::Image picture(4, 2, 3);
        for (float& value : picture.data) value = 0.25f;
        image::writeImage(folder_ / "sky.pfm", picture);
        nlohmann::json open;
        for (const char* panel : {"scene", "rendering", "camera", "view", "file", "statistics", "settings", "objects"})
            open[panel] = std::string(panel) == "objects";
        fs::create_directories(folder_ / "config" / "ray-tracing");
        store({{"open_panels", open}, {"saw_first_steps", true}, {"show_comparison", false}});
        file_ = writeScene("ball.json", "Ball");
        start({"--scene", file_.string(), "--width", "64", "--spp", "4"});
    }
    nlohmann::json saved() const {
        std::ifstream in(file_);
        return nlohmann::json::parse(in, nullptr, false);
    }
    bool isMarkedUnsaved() { return title().find("Ball*") == 0; }
    void save(const std::function<bool()>& isSaved) {
        ASSERT_TRUE(clickText("Save*", kSidePlace, isSaved)) << log() << saved();
    }
    void dropUntilEdited(const std::string& name, int x, int y) {
        const auto isDropped = [&] {
            if (isMarkedUnsaved()) return true;
            EXPECT_TRUE(drop({(folder_ / name).string()}, x, y));
            return eventually([this] { return isMarkedUnsaved(); }, 2 * kAnswered);
        };
        ASSERT_TRUE(eventually(isDropped, kSeen)) << log();
    }
    static constexpr Place kSidePlace{0, 0, kSide, kHeight};
    fs::path file_;
};
INSTANTIATE_TEST_SUITE_P(, AddedFilesTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, AddedFilesTest, kSecondProgram, nameOfProgram);

TEST_P(AddedFilesTest, AModelIsAddedByTheMenuAndSavedByItsName) {
    startWithBall();
    ASSERT_FALSE(HasFatalFailure());
    const std::string before = saved().dump();
    const auto choose = [&](const std::string& name) {
        ASSERT_TRUE(clickText("Add", kSidePlace, [this] { return isShown("Model..."); })) << log();
        ASSERT_TRUE(clickText("Model...", [this] { return isShown("Add a model"); })) << log();
        pause(1500); // until the field has the keyboard
        type((folder_ / name).string());
        key("Return");
    };
    choose("bad.obj");
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(appears("cannot be added")) << log();
    EXPECT_FALSE(isMarkedUnsaved()) << "the scene is as it was";
    choose("flag.obj");
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(appears("Instance  /objects/1", kSidePlace)) << log();
    save([this] { return saved().is_object() && saved().contains("models"); });
    EXPECT_EQ(saved()["models"]["flag"]["file"], "flag.obj");
    EXPECT_FALSE(saved()["materials"].contains("flag: red"));
    EXPECT_EQ(saved()["objects"][1]["prototype"], "flag");
    EXPECT_TRUE(saved()["objects"][1].contains("transform")) << "its own place is beside the scene";
    key("ctrl+z");
    ASSERT_TRUE(eventually([this] { return isMarkedUnsaved(); }, kSeen)) << log();
    save([this] { return saved().is_object() && !saved().contains("models"); });
    EXPECT_EQ(saved()["objects"].size(), 1u);
    expectCleanEnd();
}

TEST_P(AddedFilesTest, AModelThatIsDroppedOnThePanelIsAdded) {
    startWithBall();
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(appears("World", kSidePlace)) << log();
    dropUntilEdited("flag.obj", 180, 500);
    ASSERT_FALSE(HasFatalFailure());
    save([this] { return saved().is_object() && saved().contains("models"); });
    EXPECT_EQ(saved()["objects"].size(), 2u);
    expectCleanEnd();
}

TEST_P(AddedFilesTest, SunAndSkyIsAddedByTheMenu) {
    startWithBall();
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(clickText("Add", kSidePlace, [this] { return isShown("Sun and sky"); })) << log();
    ASSERT_TRUE(clickText("Sun and sky", [this] { return isMarkedUnsaved(); })) << log();
    save([this] { return saved().is_object() && saved()["background"]["type"] == "sun_sky"; });
    EXPECT_EQ(saved()["background"]["sun_elevation"], 40);
    key("ctrl+z");
    ASSERT_TRUE(eventually([this] { return isMarkedUnsaved(); }, kSeen)) << log();
    save([this] { return saved().is_object() && saved()["background"]["type"] == "gradient"; });
    expectCleanEnd();
}

TEST_P(AddedFilesTest, AnImageIsTheSkyOrAColorByWhereItIsDropped) {
    startWithBall();
    ASSERT_FALSE(HasFatalFailure());
    dropUntilEdited("sky.pfm", kSkyX, kSkyY);
    ASSERT_FALSE(HasFatalFailure());
    save([this] { return saved().is_object() && saved()["background"]["type"] == "image"; });
    EXPECT_EQ(saved()["background"]["file"], (folder_ / "sky.pfm").string());
    EXPECT_FALSE(saved().contains("textures"));
    dropUntilEdited("sky.pfm", kBallX, kBallY);
    ASSERT_FALSE(HasFatalFailure());
    save([this] { return saved().is_object() && saved().contains("textures"); });
    EXPECT_EQ(saved()["materials"]["m"]["albedo"], "sky");
    EXPECT_EQ(saved()["textures"]["sky"]["file"], (folder_ / "sky.pfm").string());
    key("ctrl+z");
    key("ctrl+z"); // one step each
    ASSERT_TRUE(eventually([this] { return isMarkedUnsaved(); }, kSeen)) << log();
    save([this] { return saved().is_object() && saved()["background"]["type"] == "gradient"; });
    EXPECT_FALSE(saved().contains("textures"));
    expectCleanEnd();
}

} // namespace
} // namespace rt::test
