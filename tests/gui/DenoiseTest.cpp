// The denoised picture in both windows: what is shown, and what is saved of it.
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Image/ImageIo.h"
#include "Common/Image/Metrics.h"
#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class DenoiseWindowTest : public WindowTest {
  protected:
    void startDenoising(std::vector<std::string> more = {}) {
        std::vector<std::string> arguments = {"--scene", "cornell-box-lights"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        start(arguments);
    }
    // The file that F12 writes, by the end of its name.
    fs::path saved(const std::string& end) const {
        for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "pictures"))
            if (entry.path().filename().string().ends_with(end)) return entry.path();
        return {};
    }
    bool saves(const std::string& end) {
        return eventually([&] {
            key("F12");
            return eventually([&] { return !isRunning() || !saved(end).empty(); }, kAnswered);
        });
    }
};
INSTANTIATE_TEST_SUITE_P(, DenoiseWindowTest, kBothPrograms, nameOfProgram);

// It is on at first; N turns it off. Files get what is seen, and what they are is in their names.
TEST_P(DenoiseWindowTest, AKeyTurnsItOffAndFilesGetWhatIsSeen) {
    startDenoising();
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(saves("-4spp-denoised.exr")) << log();
    key("n");
    ASSERT_TRUE(saves("-4spp.exr")) << log();
    const image::Image denoised = image::readImage(saved("-4spp-denoised.exr")),
                       raw = image::readImage(saved("-4spp.exr"));
    ASSERT_EQ(denoised.width, raw.width);
    EXPECT_GT(image::compare(raw, denoised).relmse, 0.001); // the noise
    EXPECT_TRUE(eventually([&] { return settings()["denoise"] == false; })) << settings();
    expectCleanEnd();
    EXPECT_EQ(settings()["denoise"], false);
}

class SharedDenoiseWindowTest : public DenoiseWindowTest {};
INSTANTIATE_TEST_SUITE_P(, SharedDenoiseWindowTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, SharedDenoiseWindowTest, kSecondProgram, nameOfProgram);

TEST_P(SharedDenoiseWindowTest, BothPicturesCanBeSaved) {
    startDenoising();
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(saves("-4spp-denoised.exr")) << log(); // so that there are settings
    expectCleanEnd();
    nlohmann::json stored = settings();
    EXPECT_EQ(stored["save_choice"], "seen");
    stored["save_choice"] = "both";
    store(stored);
    // A raw picture that was saved before the denoised one was seen would have given the next ones a number.
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "pictures")) fs::remove(entry);
    startDenoising();
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(saves("-4spp.denoised.exr")) << log();
    EXPECT_FALSE(saved("-4spp.exr").empty());
    EXPECT_FALSE(saved("-4spp.denoised.png").empty());
    expectCleanEnd();
}

// One sample of each pixel has no halves: the picture stays raw, and nobody waits for more.
TEST_P(SharedDenoiseWindowTest, AFilmOfOneSampleStaysRaw) {
    startDenoising({"--spp", "1"});
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_TRUE(saves("-1spp.exr")) << log();
    EXPECT_TRUE(saved("-1spp-denoised.exr").empty());
    expectCleanEnd();
}

} // namespace
} // namespace rt::test
