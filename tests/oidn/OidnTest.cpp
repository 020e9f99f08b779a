// Pictures that Open Image Denoise filters: here a library of a few lines in its place.
#include <cmath>
#include <filesystem>

#include "Common/Image/ImageIo.h"
#include "tests/program/Program.h"

namespace rt::test {
namespace {

class Oidn : public ProgramTest {
  protected:
    const Environment withLibrary_ = {{"LD_LIBRARY_PATH", RT_OIDN_STUB_DIR}};
};

TEST_F(Oidn, FiltersThePictureByItsFeatures) {
    ASSERT_EQ(render({"-o", "a.pfm", "--spp", "16", "--denoise", "oidn", "--aov", "albedo,normal", "--stats", "s.json"},
                     withLibrary_)
                  .exitCode,
              0);
    const image::Image raw = image::readImage(path("a.pfm")), albedo = image::readImage(path("a.albedo.pfm")),
                       normal = image::readImage(path("a.normal.pfm")),
                       denoised = image::readImage(path("a.denoised.pfm"));
    for (std::size_t i = 0; i < raw.data.size(); ++i)
        EXPECT_NEAR(denoised.data[i], raw.data[i] / 4 + albedo.data[i] / 2 + std::abs(normal.data[i]) / 8, 1e-5f) << i;
    const nlohmann::json statistics = jsonOf("s.json")["denoised"];
    EXPECT_EQ(statistics["library"], "Open Image Denoise 2.9.7");
    EXPECT_GT(statistics["seconds"], 0.0);
    EXPECT_FALSE(statistics.contains("estimated_relmse")); // it does not tell
}

TEST_F(Oidn, ARegionIsFilteredAlone) {
    ASSERT_EQ(
        render({"-o", "a.pfm", "--spp", "4", "--denoise", "oidn", "--region", "8,8,16,16"}, withLibrary_).exitCode, 0);
    const image::Image denoised = image::readImage(path("a.denoised.pfm"));
    EXPECT_EQ(denoised.pixel(7, 16)[0], 0);
    EXPECT_GT(denoised.pixel(16, 16)[0], 0);
}

TEST_F(Oidn, WithoutItNothingIsRendered) {
    const Environment none = {{"LD_LIBRARY_PATH", path("none")}};
    EXPECT_TRUE(failsWith(render({"-o", "a.pfm", "--denoise", "oidn"}, none), 1, "Open Image Denoise"));
    EXPECT_FALSE(std::filesystem::exists(path("a.pfm")));
}

TEST_F(Oidn, ItsErrorIsNotKnown) {
    EXPECT_TRUE(failsWith(render({"-o", "a.pfm", "--denoise", "oidn", "--target-error", "0.1"}), 2, "--target-error"));
    EXPECT_TRUE(failsWith(render({"-o", "a.pfm", "--denoise", "oidn", "--aov", "denoised-error"}), 2, "error"));
    EXPECT_TRUE(failsWith(render({"-o", "a.pfm", "--denoise", "optix"}), 2, "oidn"));
}

TEST_F(Oidn, TheBenchmarkNamesIt) {
    writeFile("s.json", R"({"version": 1, "experiments": [{"name": "e", "engine": "multi", "width": 16, "height": 16,
        "denoise": ["off", "oidn"], "spp": 4}]})");
    const Outcome with = run("ray-tracing-bench", {"s.json", "-q"}, withLibrary_);
    EXPECT_EQ(with.exitCode, 0) << with.err;
    EXPECT_NE(with.out.find("Open Image Denoise 2.9.7"), std::string::npos) << with.out;
    EXPECT_NE(with.out.find("| oidn"), std::string::npos);
    const Outcome without = run("ray-tracing-bench", {"s.json", "-q"}, {{"LD_LIBRARY_PATH", path("none")}});
    EXPECT_EQ(without.exitCode, 0) << without.err; // what is missing is left out, with a notice
    EXPECT_NE(without.out.find("cannot be loaded"), std::string::npos) << without.out;
    EXPECT_EQ(without.out.find("| oidn"), std::string::npos);
}

} // namespace
} // namespace rt::test
