// ray-tracing-image from the outside: what it prints, what it writes, its exit codes.
#include <algorithm>
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

#include "Common/Image/ImageIo.h"
#include "tests/program/RunProgram.h"

namespace rt {
namespace {

class ImageTool : public testing::Test {
  protected:
    ImageTool() {
        image::Image reference(16, 9);
        for (std::size_t i = 0; i < reference.data.size(); ++i)
            reference.data[i] = float(i % 10) / 16;
        image::writeImage(folder_ / "reference.exr", reference);
        for (float& value : reference.data)
            value += 0.25f;
        image::writeImage(folder_ / "brighter.pfm", reference);
        image::writeImage(folder_ / "small.exr", image::Image(4, 4));
    }

    std::string file(const std::string& name) const { return (folder_ / name).string(); }

    static tests::ProgramResult run(const std::vector<std::string>& arguments) {
        return tests::runProgram("ray-tracing-image", arguments);
    }

    // Fails with the code and one line on standard error that contains `text`.
    static void expectError(const std::vector<std::string>& arguments, int code, const std::string& text) {
        const tests::ProgramResult result = run(arguments);
        EXPECT_EQ(result.exitCode, code) << result.err;
        EXPECT_EQ(result.err.rfind("ray-tracing-image: ", 0), 0u) << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_NE(result.err.find(text), std::string::npos) << result.err;
        EXPECT_EQ(result.out, "");
    }

    std::size_t filesInFolder() const {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_.path()), {}));
    }

    tests::TempFolder folder_;
};

// The value that is printed behind the name.
double figure(const std::string& text, const std::string& name) {
    std::istringstream lines(text);
    std::string key, value;
    while (lines >> key >> value)
        if (key == name) return std::stod(value);
    return NAN;
}

TEST_F(ImageTool, DiffPrintsAllFigures) {
    const auto result = run({"diff", file("brighter.pfm"), file("reference.exr")});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_NEAR(figure(result.out, "mse"), 0.0625, 1e-6);
    EXPECT_NEAR(figure(result.out, "rmse"), 0.25, 1e-6);
    EXPECT_NEAR(figure(result.out, "mae"), 0.25, 1e-6);
    EXPECT_NEAR(figure(result.out, "max"), 0.25, 1e-6);
    double relative = 0;
    for (int i = 0; i < 16 * 9 * 3; ++i)
        relative += 0.0625 / (std::pow(i % 10 / 16.0, 2) + 0.01) / (16 * 9 * 3);
    EXPECT_NEAR(figure(result.out, "relmse"), relative, 1e-4);
    EXPECT_TRUE(figure(result.out, "psnr") > 10 && figure(result.out, "psnr") < 20);
}

TEST_F(ImageTool, DiffComparesWithTheLimit) {
    const auto code = [&](const std::string& metric, const std::string& max) {
        return run({"diff", file("brighter.pfm"), file("reference.exr"), "--metric", metric, "--max", max}).exitCode;
    };
    EXPECT_EQ(code("mse", "0.063"), 0);
    EXPECT_EQ(code("mse", "0.062"), 5);
    EXPECT_EQ(code("rmse", "0.062"), 5);
    EXPECT_EQ(code("mae", "0.26"), 0);
    EXPECT_EQ(code("relmse", "1e9"), 0);
    EXPECT_EQ(code("relmse", "0"), 5);
    EXPECT_EQ(code("psnr", "5"), 0);  // at least 5 dB
    EXPECT_EQ(code("psnr", "50"), 5);
    EXPECT_EQ(run({"diff", file("brighter.pfm"), file("reference.exr"), "--max", "0.0624"}).exitCode, 5);
    EXPECT_EQ(run({"diff", file("small.exr"), file("small.exr"), "--max", "0", "--metric", "psnr"}).exitCode, 0);
    const auto one = run({"diff", file("brighter.pfm"), file("reference.exr"), "--metric", "mae"});
    EXPECT_EQ(one.out, "mae 0.25\n");
}

TEST_F(ImageTool, DiffWritesAHeatMap) {
    // Also when the images differ too much.
    EXPECT_EQ(
        run({"diff", file("brighter.pfm"), file("reference.exr"), "--max", "0", "--output", file("heat.png")}).exitCode,
        5);
    const image::Image heat = image::readImage(file("heat.png"));
    EXPECT_EQ(heat.width, 16u);
    EXPECT_EQ(heat.height, 9u);
}

TEST_F(ImageTool, ConvertsBetweenFormats) {
    EXPECT_EQ(run({"convert", file("reference.exr"), file("copy.pfm")}).exitCode, 0);
    EXPECT_EQ(image::readImage(file("copy.pfm")).data, image::readImage(file("reference.exr")).data);
    EXPECT_EQ(run({"convert", file("reference.exr"), file("shown.png")}).exitCode, 0);
    // sRGB-encoded and decoded again: off by half a level, at most 1/255 * 2.4 / 2
    const auto shown = run({"diff", file("shown.png"), file("reference.exr")});
    EXPECT_LT(figure(shown.out, "max"), 0.0048);
    EXPECT_EQ(
        run({"convert", file("reference.exr"), file("two.png"), "--exposure", "1", "--tonemap", "reinhard"}).exitCode,
        0);
    expectError({"convert", file("reference.exr"), file("two.exr"), "--exposure", "1"}, 2, ".png only");
    expectError({"convert", file("reference.exr"), file("two.png"), "--tonemap", "film"}, 2, "reinhard");
}

TEST_F(ImageTool, InfoDescribes) {
    const auto result = run({"info", file("reference.exr")});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_NE(result.out.find("size 16 9\nchannels 3\nmin 0\nmax 0.5625\nmean "), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("\nnonfinite 0\n"), std::string::npos) << result.out;
}

TEST_F(ImageTool, HelpAndVersion) {
    EXPECT_EQ(run({"--help"}).exitCode, 0);
    EXPECT_NE(run({"--help"}).out.find("convert"), std::string::npos);
    EXPECT_NE(run({"diff", "--help"}).out.find("--metric"), std::string::npos);
    EXPECT_EQ(run({"--version"}).out.rfind("ray-tracing-image ", 0), 0u);
}

TEST_F(ImageTool, WrongUseExitsWith2) {
    expectError({}, 2, "subcommand is required");
    expectError({"paint"}, 2, "paint");
    expectError({"diff", file("reference.exr")}, 2, "B");
    expectError({"diff", file("small.exr"), file("small.exr"), "--metric", "ssim"}, 2, "mse");
    expectError({"diff", file("small.exr"), file("small.exr"), "--max", "little"}, 2, "little");
    expectError({"diff", file("small.exr"), file("small.exr"), "--max", "nan"}, 2, "--max");
    expectError({"diff", file("small.exr"), file("small.exr"), "--output", file("heat.gif")}, 2, ".exr");
    expectError({"convert", file("reference.exr"), file("out.jpg")}, 2, "allowed: .png, .exr, .hdr, .pfm");
    expectError({"info", file("small.exr"), "--loud"}, 2, "--loud");
}

TEST_F(ImageTool, BadInputExitsWith3) {
    expectError({"info", file("none.exr")}, 3, "none.exr");
    expectError({"info", file("")}, 3, "allowed");
    expectError({"diff", file("small.exr"), file("reference.exr")}, 3, "4x4");
    expectError({"convert", file("none.pfm"), file("out.png")}, 3, "none.pfm");
    std::filesystem::resize_file(file("reference.exr"), 500);
    expectError({"diff", file("reference.exr"), file("brighter.pfm")}, 3, "truncated");
    std::ofstream(file("nan.pfm"), std::ios::binary) << std::string("Pf\n1 1\n-1.0\n\0\0\xc0\x7f", 16);
    expectError({"diff", file("nan.pfm"), file("nan.pfm")}, 3, "not finite");
}

TEST_F(ImageTool, FailingOutputExitsWith1AndLeavesNothing) {
    const std::size_t before = filesInFolder();
    expectError({"convert", file("small.exr"), file("no/such/folder.png")}, 1, "folder.png");
    std::filesystem::create_directory(file("taken.png"));
    expectError({"convert", file("small.exr"), file("taken.png")}, 1, "taken.png");
    EXPECT_EQ(filesInFolder(), before + 1);
}

#ifdef __linux__
TEST_F(ImageTool, FullDiskExitsWith1AndKeepsTheOldFile) {
    image::writeImage(file("old.exr"), image::Image(2, 2));
    image::writeImage(file("large.exr"), image::Image(100, 100));
    const std::size_t before = filesInFolder();
    // Files of at most one block of 512 bytes.
    const auto result = tests::runProgram("ray-tracing-image", {"convert", file("large.exr"), file("old.exr")},
                                          "trap '' XFSZ; ulimit -f 1; ");
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_NE(result.err.find("old.exr: File too large"), std::string::npos) << result.err;
    EXPECT_EQ(image::readImage(file("old.exr")).width, 2u);
    EXPECT_EQ(filesInFolder(), before);

    const auto full = tests::runProgram("ray-tracing-image", {"info", file("large.exr")}, "", ">/dev/full");
    EXPECT_EQ(full.exitCode, 1);
    EXPECT_EQ(full.err, "ray-tracing-image: cannot write to standard output\n");
}
#endif

}  // namespace
}  // namespace rt
