// A scene that is edited by way of a window: clicked, changed, undone, saved.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class EditingTest : public WindowTest {
  protected:
    static constexpr int kBallX = 826, kBallY = 470; // of the screen: near the picture's middle,
    static constexpr int kMiddleY = 449;             // which is here

    // Of the panels only that of the objects is folded out.
    void startWith(const fs::path& file) {
        storeOpenObjects();
        file_ = file;
        start({"--scene", file_.string(), "--width", "64", "--spp", "4"});
    }
    // The scene is one ball in the picture's middle.
    void startWithBall() { startWith(writeScene("ball.json", "Ball")); }
    // Three of them in a row.
    void startWithThreeBalls() { startWith(writeThreeBalls("balls.json", "Ball")); }
    // Pixels of the window for a unit of length at the balls, about: the picture is as high as the space for it, and 6
    // units are seen of it.
    static constexpr int kUnit = 133;
    void save(const std::function<bool()>& isSaved) {
        ASSERT_TRUE(clickText("Save*", kSidePlace, isSaved)) << log() << saved();
    }
    double centerOf(std::size_t object, int axis) const {
        const nlohmann::json scene = saved();
        const bool isThere = scene.is_object() && scene["objects"].size() > object;
        return isThere ? scene["objects"][object]["center"][static_cast<std::size_t>(axis)].get<double>() : -99;
    }
    nlohmann::json saved() const {
        std::ifstream in(file_);
        return nlohmann::json::parse(in, nullptr, false);
    }
    bool isMarkedUnsaved() { return title().find("Ball*") == 0; }
    bool isSelected(const std::string& title) const { return isShown(title, kSidePlace); }
    bool selectBall() {
        return clickPlace(kBallX, kBallY, [this] { return isSelected("Sphere  /objects/0"); });
    }
    // The window is closed, the edits are saved, and the ball has that material in the file.
    void endAndExpectOnBall(const std::string& material) {
        key("ctrl+q");
        ASSERT_TRUE(appears("Save them")) << log();
        const auto isSaved = [&] { return saved().is_object() && saved()["materials"].contains(material); };
        ASSERT_TRUE(clickText("Save them", isSaved)) << log();
        EXPECT_EQ(waitForEnd(), 0) << log();
        EXPECT_EQ(saved()["objects"][0]["material"], material);
    }
    static constexpr Place kSidePlace{0, 0, kSide, kHeight};
    fs::path file_;
};
INSTANTIATE_TEST_SUITE_P(, EditingTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, EditingTest, kSecondProgram, nameOfProgram);

TEST_P(EditingTest, ABallBecomesMetalALightIsAddedAndBothAreSaved) {
    startWithBall();
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(selectBall()) << log();
    ASSERT_TRUE(clickText("Lambertian", kSidePlace, [this] { return isShown("Dielectric"); })) << log();
    ASSERT_TRUE(clickText("Metal", [this] { return !isShown("Dielectric") && isShown("Fuzz", kSidePlace); })) << log();
    EXPECT_TRUE(eventually([this] { return isMarkedUnsaved(); }, kSeen)) << title();
    ASSERT_TRUE(clickText("Add", kSidePlace, [this] { return isShown("Point light"); })) << log();
    ASSERT_TRUE(clickText("Point light", [this] { return isShown("Intensity", kSidePlace); })) << log();
    key("ctrl+z");
    EXPECT_TRUE(eventually([this] { return !isShown("1  Point light", kSidePlace); }, kSeen)) << log();
    key("ctrl+y");
    EXPECT_TRUE(eventually([this] { return isShown("1  Point light", kSidePlace); }, kSeen)) << log();
    ASSERT_TRUE(clickText("Save*", kSidePlace, [this] { return !isMarkedUnsaved(); })) << log();
    ASSERT_TRUE(eventually([this] { return saved().is_object() && saved()["objects"].size() == 2; })) << saved();
    const nlohmann::json scene = saved();
    EXPECT_EQ(scene["objects"][0]["type"], "sphere");
    EXPECT_EQ(scene["objects"][1]["type"], "point_light");
    EXPECT_EQ(scene["materials"]["m"]["type"], "metal");
    expectCleanEnd();
}

#ifdef RT_HAS_PUGIXML
// Nothing is selected: it is for what is under the pointer.
TEST_P(EditingTest, TheBallGetsTheMaterialOfAFileThatIsDroppedOnIt) {
    std::ofstream(folder_ / "cherry.mtlx") << R"(<materialx version="1.38"><gltf_pbr name="S" type="surfaceshader">
        <input name="base_color" type="color3" value="0.5, 0, 0"/><input name="metallic" type="float" value="0"/></gltf_pbr>
        <surfacematerial name="Cherry" type="material"><input name="surfaceshader" type="surfaceshader" nodename="S"/>
        </surfacematerial></materialx>)";
    startWithBall();
    ASSERT_FALSE(HasFatalFailure());
    const auto isDropped = [this] {
        if (isMarkedUnsaved()) return true;
        EXPECT_TRUE(drop({(folder_ / "cherry.mtlx").string()}, kBallX, kBallY));
        return eventually([this] { return isMarkedUnsaved(); }, 2 * kAnswered);
    };
    ASSERT_TRUE(eventually(isDropped, kSeen)) << log();
    endAndExpectOnBall("Cherry");
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_EQ(saved()["materials"]["Cherry"]["base_color"][0], 0.5);
}
#endif

// By a click for what is selected, and by a drag onto the ball for the ball.
TEST_P(EditingTest, TheBallGetsMaterialsOfTheLibrary) {
    startWithBall();
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(selectBall()) << log();
    // The wheel brings what is below the fields of the ball to where it is seen.
    const auto scrolled = [this] {
        if (!isShown("Search materials", kSidePlace)) act("mousemove 180 500 click 5 click 5 click 5 sleep 0.5");
        return isShown("Search materials", kSidePlace);
    };
    ASSERT_TRUE(clickText("Material library", kSidePlace, scrolled)) << log();
    ASSERT_TRUE(clickText("Search materials", kSidePlace, [this] { return !isShown("Search materials"); })) << log();
    type("gold");
    ASSERT_TRUE(eventually([this] { return isShown("Matt gold", kSidePlace) && !isShown("Silver"); }, kSeen)) << log();
    ASSERT_TRUE(clickText("Gold", kSidePlace, [this] { return isMarkedUnsaved(); })) << log();
    key("ctrl+z");
    EXPECT_TRUE(eventually([this] { return !isMarkedUnsaved(); }, kSeen)) << title();
    const auto isDropped = [this] {
        const std::vector<Place> from = placesOf("Matt gold", kSidePlace);
        if (from.empty() || isMarkedUnsaved()) return isMarkedUnsaved();
        const std::string start = std::to_string(from.front().x()) + " " + std::to_string(from.front().y());
        const std::string end = std::to_string(kBallX) + " " + std::to_string(kBallY);
        act("mousemove " + start + " sleep 0.3 mousedown 1 sleep 0.3 mousemove_relative 30 -20 sleep 0.3 mousemove " +
            end + " sleep 0.5 mouseup 1 sleep 0.3");
        return eventually([this] { return isMarkedUnsaved(); }, kAnswered);
    };
    ASSERT_TRUE(eventually(isDropped, kSeen)) << log();
    endAndExpectOnBall("Matt gold");
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_EQ(saved()["materials"]["Matt gold"]["metallic"], 1);
    EXPECT_FALSE(saved()["materials"].contains("Gold")) << "taken back";
}

// By keys alone from where the ball is selected; whoever closes the window is asked.
TEST_P(EditingTest, AnObjectIsMovedByKeysAndEditsAreNotLostInSilence) {
    startWithBall();
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(selectBall()) << log();
    act("mousemove " + std::to_string(kBallX) + " " + std::to_string(kBallY) + " sleep 0.5");
    key("g");
    act("sleep 0.5 key x sleep 0.5 mousemove_relative 60 30 sleep 0.5 mousemove_relative 40 20 sleep 0.5 click 1");
    EXPECT_TRUE(eventually([this] { return isMarkedUnsaved(); }, kSeen)) << title() << log();
    act("sleep 0.5 key s sleep 0.5 mousemove_relative 60 30 sleep 0.5 key Escape sleep 0.5"); // as if it had not been
    key("ctrl+q");
    ASSERT_TRUE(appears("Save them")) << log();
    const auto isSaved = [this] { return saved().is_object() && saved()["objects"][0]["center"][0] > 0.1; };
    ASSERT_TRUE(clickText("Save them", isSaved)) << log();
    EXPECT_EQ(waitForEnd(), 0) << log();
    const nlohmann::json ball = saved()["objects"][0];
    EXPECT_GT(ball["center"][0], 0.1);
    EXPECT_EQ(ball["center"][1], 0);
    EXPECT_EQ(ball["center"][2], 0);
    EXPECT_EQ(ball["radius"], 1);
}

TEST_P(EditingTest, SeveralObjectsAreOneToToolsAndToUndo) {
    startWithThreeBalls();
    ASSERT_FALSE(HasFatalFailure());
    const auto isFirst = [this] { return isSelected("Sphere  /objects/0"); };
    ASSERT_TRUE(clickPlace(kBallX - 3 * kUnit / 2, kBallY, isFirst)) << log();
    act("keydown ctrl");
    click(kBallX + 3 * kUnit / 2, kBallY);
    act("keyup ctrl");
    ASSERT_TRUE(appears("Sphere  /objects/2", kSidePlace)) << log();
    ASSERT_TRUE(appears("And 1 more", kSidePlace)) << log();
    act("mousemove " + std::to_string(kBallX) + " 300 sleep 0.5");
    key("g");
    act("sleep 0.5 key y sleep 0.5 mousemove_relative 0 -60 sleep 0.5 mousemove_relative 0 -40 sleep 0.5 click 1");
    ASSERT_TRUE(eventually([this] { return isMarkedUnsaved(); }, kSeen)) << title() << log();
    save([this] { return centerOf(0, 1) > 0.1; });
    EXPECT_GT(centerOf(0, 1), 0.3);
    EXPECT_EQ(centerOf(0, 1), centerOf(2, 1));
    EXPECT_EQ(centerOf(1, 1), 0);
    key("Delete");
    ASSERT_TRUE(eventually([this] { return isMarkedUnsaved(); }, kSeen)) << log();
    save([this] { return saved().is_object() && saved()["objects"].size() == 1; });
    EXPECT_EQ(centerOf(0, 0), 0);
    key("ctrl+z");
    key("ctrl+z"); // one step each
    ASSERT_TRUE(eventually([this] { return isMarkedUnsaved(); }, kSeen)) << log();
    save([this] { return saved().is_object() && saved()["objects"].size() == 3; });
    for (const std::size_t i : {0u, 1u, 2u}) EXPECT_EQ(centerOf(i, 1), 0);
    expectCleanEnd();
}

// By the arrow to the right; with Ctrl by whole steps; with Shift a copy. A drag beside it moves the camera alone.
TEST_P(EditingTest, TheGizmoMovesSnapsAndDuplicates) {
    startWithBall();
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(selectBall()) << log();
    const std::string onArrow = "mousemove " + std::to_string(kBallX + 45) + " " + std::to_string(kMiddleY);
    const std::string way = " sleep 0.5 mousemove_relative 40 2 sleep 0.5 mousemove_relative 60 3 sleep 0.8";
    act(onArrow + " sleep 0.5 mousedown 1" + way + " key Escape sleep 0.5 mouseup 1"); // as if it had not been
    EXPECT_FALSE(isMarkedUnsaved());
    act(onArrow + " sleep 0.5 mousedown 1 sleep 0.3 keydown ctrl" + way + " mouseup 1 keyup ctrl sleep 0.5");
    ASSERT_TRUE(eventually([this] { return isMarkedUnsaved(); }, kSeen)) << title() << log();
    save([this] { return centerOf(0, 0) > 0.1; });
    EXPECT_TRUE(centerOf(0, 0) == 0.6 || centerOf(0, 0) == 0.8) << saved();
    EXPECT_EQ(centerOf(0, 1), 0);
    EXPECT_EQ(centerOf(0, 2), 0);
    key("ctrl+z");
    ASSERT_TRUE(eventually([this] { return isMarkedUnsaved(); }, kSeen)) << title() << log();
    pause(1500); // until the gizmo is back
    act(onArrow + " sleep 0.5 keydown shift mousedown 1" + way + " mouseup 1 keyup shift sleep 0.5");
    save([this] { return saved().is_object() && saved()["objects"].size() == 2; });
    EXPECT_EQ(centerOf(0, 0), 0);
    EXPECT_GT(centerOf(1, 0), 0.3);
    EXPECT_EQ(centerOf(1, 2), 0);
    key("ctrl+z"); // the copy and its way are one step
    ASSERT_TRUE(eventually([this] { return isMarkedUnsaved(); }, kSeen)) << title() << log();
    save([this] { return saved().is_object() && saved()["objects"].size() == 1; });
    ASSERT_TRUE(selectBall()) << log();
    act("mousemove 500 300 sleep 0.5 mousedown 1 sleep 0.5 mousemove_relative 2 60 sleep 0.5 mouseup 1 sleep 1");
    EXPECT_FALSE(isMarkedUnsaved());
    EXPECT_TRUE(isSelected("Sphere  /objects/0")) << "a drag is no click";
    expectCleanEnd();
}

TEST_P(EditingTest, WhatIsHiddenIsNotInThePictureAndStaysInTheFile) {
    startWithThreeBalls();
    ASSERT_FALSE(HasFatalFailure());
    const auto isMiddle = [this] { return isSelected("Sphere  /objects/1"); };
    ASSERT_TRUE(clickPlace(kBallX, kBallY, isMiddle)) << log();
    pointAtNothing();
    key("h");
    ASSERT_TRUE(eventually([this] { return isMarkedUnsaved(); }, kSeen)) << title() << log();
    const auto isHidden = [this](std::size_t object) {
        const nlohmann::json scene = saved();
        return scene.is_object() && scene["objects"][object].value("hidden", false);
    };
    save([&] { return isHidden(1); });
    EXPECT_FALSE(isHidden(0));
    key("Escape");
    pause(1000);
    click(kBallX, kBallY); // there is nothing any more
    pause(1500);
    EXPECT_FALSE(isSelected("Sphere  /objects/1"));
    ASSERT_TRUE(clickText("Show all", kSidePlace, [this] { return isMarkedUnsaved(); })) << log();
    save([&] { return !isHidden(1); });
    ASSERT_TRUE(clickPlace(kBallX, kBallY, isMiddle)) << log();
    key("shift+h");
    save([&] { return isHidden(0) && isHidden(2); });
    EXPECT_FALSE(isHidden(1));
    key("alt+h");
    save([&] { return !isHidden(0) && !isHidden(2); });
    expectCleanEnd();
}

} // namespace
} // namespace rt::test
