// SIGTERM at random moments in the life of a window, each call of the driver slowed down at random.
#include <random>
#include <signal.h>

#include "Common/Image/ImageIo.h"
#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class NightlyWindowSignalTest : public WindowTest {
  protected:
    int upTo(int maximum) { return std::uniform_int_distribution<int>(0, maximum)(random_); }
    // Changes what is rendered, shown and saved.
    void actAtRandom() {
        const char* const keys[] = {"F12",    "F11",  "ctrl+equal", "ctrl+minus", "space",
                                    "Escape", "Next", "Prior",      "w",          "Tab"};
        for (int count = upTo(12); count > 0 && isRunning(); --count) {
            key(keys[upTo(static_cast<int>(std::size(keys)) - 1)]);
            act("mousemove " + std::to_string(upTo(kWidth - 1)) + " " + std::to_string(upTo(kHeight - 1)));
            pause(upTo(60));
        }
    }

    std::mt19937 random_{12};
};
INSTANTIATE_TEST_SUITE_P(, NightlyWindowSignalTest, kBothPrograms, nameOfProgram);

TEST_P(NightlyWindowSignalTest, EndsAsDocumented) {
    const fs::path image = folder_ / "a.exr";
    for (int round = 0; round < 40; ++round) {
        fs::remove(image);
        environment_ = {{"VK_ADD_LAYER_PATH", RT_LAYER_DIR},
                        {"VK_INSTANCE_LAYERS", "VK_LAYER_RT_faults"},
                        {"RT_DELAYS", std::to_string(round % 4 * 4)}};
        start({"--window", "--spp", "1000000", "-o", image.string()});
        ASSERT_FALSE(HasFatalFailure());
        actAtRandom();
        pause(upTo(300));
        EXPECT_EQ(endBySignal(round % 2 == 0 ? SIGTERM : SIGINT), 130) << round << '\n' << log();
        EXPECT_TRUE(!fs::exists(image) || image::readImage(image).width > 0) << round;
    }
}

} // namespace
} // namespace rt::test
