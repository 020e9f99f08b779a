// ray-tracing-image paths from the outside: what it traces again is the pixel that ray-tracing-cpu renders.
#include <string>

#include "Common/Image/ImageIo.h"
#include "tests/program/Program.h"

namespace rt::test {

class PathsTool : public ProgramTest {
  protected:
    Outcome paths(const Arguments& more) const {
        Arguments arguments = {"paths", "cornell-box-lights", "13,20", "--width", "32", "--spp", "40"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run("ray-tracing-image", arguments);
    }
};

TEST_F(PathsTool, TracesThePixelOfARender) {
    for (const char* estimator : {"mis", "bsdf"}) {
        const Arguments settings = {"--light-sampling", estimator, "--seed", "3", "--max-depth", "8"};
        Arguments more = settings;
        more.insert(more.end(), {"--spp", "40", "-o", "picture.pfm"});
        ASSERT_EQ(render(more).exitCode, 0);
        const image::Image picture = image::readImage(path("picture.pfm"));
        more = settings;
        more.emplace_back("--json");
        const Outcome outcome = paths(more);
        ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
        const nlohmann::json figures = nlohmann::json::parse(outcome.out);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(figures["radiance"][c].get<double>(), picture.pixel(13, 20)[c],
                        1e-5 * picture.pixel(13, 20)[c]);
        EXPECT_EQ(figures["luminance"].size(), 40u);
    }
}

TEST_F(PathsTool, PrintsAndDraws) {
    const Outcome outcome = paths({"--sample", "3", "-o", "strip.png"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    for (const char* text : {"13,20, 40 samples", "of the variance is light found by", "By technique", "By bounces"})
        EXPECT_NE(outcome.out.find(text), std::string::npos) << outcome.out;
    EXPECT_GE(image::readImage(path("strip.png")).width, 40u);
    EXPECT_EQ(paths({"--json"}).out, paths({"--json"}).out);
    EXPECT_NE(paths({"--json", "--seed", "1"}).out, paths({"--json"}).out);
}

TEST_F(PathsTool, SaysWhatIsWrong) {
    EXPECT_TRUE(failsWith(paths({"--sample", "40"}), 2, "below --spp"));
    EXPECT_TRUE(failsWith(paths({"--sampler", "none"}), 2, "sobol"));
    EXPECT_TRUE(failsWith(paths({"-o", "a.jpg"}), 2, ".png"));
    EXPECT_TRUE(failsWith(run("ray-tracing-image", {"paths", "cornell-box-lights", "700,1"}), 2, "0,0 to 599,599"));
    EXPECT_TRUE(failsWith(run("ray-tracing-image", {"paths", "nowhere", "1,1"}), 3, "nowhere"));
}

} // namespace rt::test
