// Thousands of edits by keyboard and mouse that nobody would make, and all of them undone.
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

// What objects, materials and lights that the window can add need, by one kernel: a software driver compiles for
// seconds.
constexpr const char* kWhatEditsNeed =
    "textures,spheres,quads,triangles,instances,emissive,volumes,sky,sky-image,lights,many-lights,sphere-lights,"
    "quad-lights,triangle-lights,punctual-lights,disks,disk-lights,lambertian,metal,dielectric,principled,fuzz,opacity";

class NightlyRandomEditsTest : public WindowTest {
  protected:
    int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
    std::string placeWithin(const Place& place) {
        return std::to_string(place.left + below(place.right - place.left)) + " " +
               std::to_string(place.top + below(place.bottom - place.top));
    }
    bool isMarkedUnsaved() { return title().find("Balls*") == 0; }
    void startWithBalls();
    void editAtRandom();
    void editInPanel();
    void openAgain();

    static constexpr Place kPicture{470, 100, 1180, 800}; // where objects can be
    static constexpr Place kSidePlace{0, 0, kSide, kHeight};
    static constexpr int kRow = 29;

  private:
    std::mt19937 random_{20261129};
};
INSTANTIATE_TEST_SUITE_P(, NightlyRandomEditsTest, kBothPrograms, nameOfProgram);

void NightlyRandomEditsTest::startWithBalls() {
    writeThreeBalls("balls.json", "Balls");
    storeOpenObjects();
    start({"--scene", (folder_ / "balls.json").string(), "--width", "32", "--spp", "2", "--features", kWhatEditsNeed});
}

void NightlyRandomEditsTest::editAtRandom() {
    static constexpr const char* kKeys[] = {"ctrl+z", "ctrl+z", "ctrl+y", "Delete",  "shift+d", "h",
                                            "alt+h",  "F6",     "Home",   "shift+h", "Escape",  "f"};
    static constexpr const char* kTransforms[] = {"g", "r", "s"};
    static constexpr const char* kAxes[] = {"x", "y", "z"};
    static constexpr const char* kEnds[] = {"key Return", "click 1", "key Escape", "click 3"};
    const auto oneOf = [this](const auto& words) {
        return std::string(words[below(static_cast<int>(std::size(words)))]);
    };
    switch (below(8)) {
        case 0:
            return act("mousemove " + placeWithin(kPicture) + " click 1");
        case 1:
            return act("keydown ctrl mousemove " + placeWithin(kPicture) + " click 1 keyup ctrl");
        case 2: {
            const std::string axis = below(2) == 0 ? " key " + oneOf(kAxes) : "";
            return act("mousemove " + placeWithin(kPicture) + " key " + oneOf(kTransforms) + axis + " mousemove " +
                       placeWithin(kPicture) + " sleep 0.05 " + oneOf(kEnds));
        }
        case 3:
            return act("mousemove " + placeWithin(kPicture) + " mousedown 1 sleep 0.05 mousemove " +
                       placeWithin(kPicture) + " sleep 0.05 mouseup 1");
        case 4:
        case 5:
        case 6:
            return editInPanel();
        default:
            return key(oneOf(kKeys));
    }
}

// Where the panel's parts are follows from what is selected. Rows of other panels, which would open other scenes, and
// the button that saves are left alone.
void NightlyRandomEditsTest::editInPanel() {
    const Screenshot shot = screenshot();
    const auto rowOf = [&](const std::string& text) {
        const std::vector<Place> places = findText(shot, text, kSidePlace);
        return places.empty() ? 0 : places.front().y();
    };
    const int add = rowOf("Add"), search = rowOf("Search objects"), library = rowOf("Material library"),
              sky = rowOf("Sky");
    if (add == 0 || search == 0 || library == 0) return key("Escape"); // a menu or a question hides them
    const Place tree{20, search + kRow / 2, 340, library - kRow / 2};
    const Place fields{14, library + kRow, 345, (sky == 0 ? 800 : sky) - kRow / 2};
    switch (below(4)) {
        case 0:
            return act("mousemove " + placeWithin(tree) + " click 1");
        case 1:
            return act("mousemove " + placeWithin({14, add + kRow - 9, 345, add + kRow + 9}) + " click 1"); // tools
        case 2:
            return act("mousemove 53 " + std::to_string(add) + " click 1 sleep 0.2 mousemove " +
                       placeWithin({30, add + kRow / 2, 180, add + 11 * kRow}) + " click 1 sleep 0.1");
        default:
            if (fields.bottom - fields.top < kRow) return key("Escape"); // nothing is selected
            act("mousemove " + placeWithin(fields) + " click 1 sleep 0.1 key ctrl+a");
            type(std::to_string(below(30) - 10));
            return act("key Return mousemove " + placeWithin(fields) + " click 1");
    }
}

// Keys that reach another panel may have opened another scene.
void NightlyRandomEditsTest::openAgain() {
    const auto isOpen = [this] {
        if (title().find("Balls") == 0) return true;
        key("Escape");
        EXPECT_TRUE(drop({(folder_ / "balls.json").string()}));
        pause(1000);
        const std::vector<Place> discard = placesOf("Discard them");
        if (!discard.empty()) click(discard.front().x(), discard.front().y());
        return title().find("Balls") == 0;
    };
    ASSERT_TRUE(eventually(isOpen, kSeen)) << title() << log();
}

// The program runs and answers, validation has nothing to say, and what is undone altogether is what was opened.
TEST_P(NightlyRandomEditsTest, AllAreUndone) {
    constexpr int kEdits = 2000, kLook = 20, kAtOnce = 100;
    startWithBalls();
    ASSERT_FALSE(HasFatalFailure());
    bool wasEdited = false;
    for (int i = 0; i < kEdits; ++i) {
        editAtRandom();
        ASSERT_TRUE(isRunning()) << "after edit " << i << "\n" << log();
        if (i % kLook != 0) continue;
        key("Escape"); // from menus and questions, which take all that comes after
        wasEdited |= isMarkedUnsaved();
        openAgain();
        ASSERT_FALSE(HasFatalFailure());
    }
    EXPECT_TRUE(wasEdited) << title();
    act("key Escape key Escape mousemove 1000 300 sleep 1");
    openAgain();
    const auto isUndone = [this] {
        if (!isMarkedUnsaved()) return true;
        std::string keys = "key";
        for (int i = 0; i < kAtOnce; ++i) keys += " ctrl+z";
        act(keys);
        pause(2000);
        return !isMarkedUnsaved();
    };
    EXPECT_TRUE(eventually(isUndone, std::chrono::minutes(20))) << title() << log();
    expectCleanEnd();
}

} // namespace
} // namespace rt::test
