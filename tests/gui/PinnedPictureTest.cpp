// A pinned picture beside the one that is rendered: by a line, by turns, and as their difference; in all views.
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Image/ImageIo.h"
#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

// Columns of the screen in A and in B, and a row, in the picture.
constexpr int kInA = 640, kInB = 1000, kMiddleRow = 450;

class PinnedPictureTest : public WindowTest {
  protected:
    // A picture of one colour: a sky, and a ball out of sight.
    std::string skyOf(const std::string& name, const std::string& color) const {
        const fs::path file = folder_ / (name + ".json");
        std::ofstream(file) << R"({"version": 1, "title": ")" << name << R"(",
            "camera": {"look_from": [0, 0, 0], "look_at": [1, 0, 0]},
            "background": {"type": "constant", "color": )"
                            << color << R"(}, "materials": {"m": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}},
            "objects": [{"type": "sphere", "center": [-50, 0, 0], "radius": 1, "material": "m"}]})";
        return file.string();
    }
    void startWith(const std::string& scene, std::vector<std::string> arguments = {}) {
        fs::create_directories(folder_ / "config" / "ray-tracing");
        store({{"saw_first_steps", true}});
        arguments.insert(arguments.end(), {"--scene", scene});
        start(arguments);
    }
    static bool isRed(std::uint32_t color) { return (color >> 16) > 90 && (color >> 8 & 0xff) < 60; }
    static bool isGreen(std::uint32_t color) { return (color >> 16) < 60 && (color >> 8 & 0xff) > 90; }
    std::uint32_t left() const { return screenshot().at(kInA, kMiddleRow); }
    std::uint32_t right() const { return screenshot().at(kInB, kMiddleRow); }
    // Too early where there is no picture yet.
    bool pin() {
        std::chrono::seconds patience(1); // longer each time, as the key undoes what is about to be seen
        return eventually([&] {
            key("b");
            patience *= 2;
            return eventually([&] { return screenshot().at(826, 500) == 0xffffff; }, patience); // the line
        });
    }
};
INSTANTIATE_TEST_SUITE_P(, PinnedPictureTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, PinnedPictureTest, kSecondProgram, nameOfProgram);

TEST_P(PinnedPictureTest, IsComparedByALineByTurnsAndByDifference) {
    const std::string green = skyOf("green", "[0, 0.5, 0]");
    startWith(skyOf("red", "[0.5, 0, 0]"));
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(eventually([&] { return isRed(left()) && isRed(right()); })) << std::hex << left();
    ASSERT_TRUE(pin());
    ASSERT_TRUE(drop({green}));
    EXPECT_TRUE(eventually([&] { return isRed(left()) && isGreen(right()); })) << log();
    key("v"); // by turns
    std::set<bool> seen;
    EXPECT_TRUE(eventually(
        [&] {
            const std::uint32_t a = left();
            if (isRed(a) || isGreen(a)) seen.insert(isRed(a));
            return seen.size() == 2;
        },
        kSeen));
    key("v"); // B - A about grey: no red, much green
    const auto isDifference = [&] {
        const std::uint32_t a = left(), b = right();
        return a == b && isGreen(a);
    };
    EXPECT_TRUE(eventually(isDifference, kSeen)) << std::hex << left();
    EXPECT_TRUE(appears("B - A, fourfold, about grey")); // B alone, by turns, is green on both sides, too
    key("v");
    EXPECT_TRUE(eventually([&] { return isRed(left()) && isGreen(right()); }, kSeen));
    expectCleanEnd();
}

// The error of each against the reference, and labels that say what both sides show.
TEST_P(PinnedPictureTest, BothSidesShowTheError) {
    image::Image reference(48, 48);
    for (std::size_t i = 0; i < reference.data.size(); i += 3) reference.data[i] = 0.4f;
    image::writeImage(folder_ / "reference.pfm", reference);
    startWith(skyOf("red", "[0.5, 0, 0]"), {"--reference", (folder_ / "reference.pfm").string()});
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(eventually([&] { return isRed(left()) && isRed(right()); })) << log();
    ASSERT_TRUE(appears("denoised relMSE")) << log(); // the picture before it is raw, and would be pinned so
    ASSERT_TRUE(pin());
    const std::uint32_t plain = right();
    EXPECT_TRUE(clickText("Error", [&] { return right() != plain; }));
    EXPECT_TRUE(eventually([&] { return left() == right(); }, kSeen)) << std::hex << left() << " " << right();
    EXPECT_NE(left(), plain);
    const std::string program = std::string(GetParam()) == "ray-tracing-cpu" ? "CPU" : "GPU";
    EXPECT_TRUE(appears("A: " + program + ", 4 spp, denoised, pinned, Error, relMSE")) << log();
    EXPECT_TRUE(appears("B: " + program + ", 4 spp, denoised, Error, relMSE")) << log();
    expectCleanEnd();
}

} // namespace
} // namespace rt::test
