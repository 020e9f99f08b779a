// ray-tracing-image from the outside: what it prints, what it writes, its exit codes.
#include <cmath>
#include <sstream>

#include <nlohmann/json.hpp>

#include "Common/Image/Checkpoint.h"
#include "Common/Image/Film.h"
#include "Common/Image/ImageIo.h"
#include "tests/program/Program.h"
#include "tests/unit/ExrFiles.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class ImageTool : public ProgramTest {
  protected:
    void SetUp() override {
        ProgramTest::SetUp();
        image::Image reference(16, 9);
        for (std::size_t i = 0; i < reference.data.size(); ++i) reference.data[i] = float(i % 10) / 16;
        image::writeImage(path("reference.exr"), reference);
        for (float& value : reference.data) value += 0.25f;
        image::writeImage(path("brighter.pfm"), reference);
        image::writeImage(path("small.exr"), image::Image(4, 4));
    }

    Outcome tool(const Arguments& arguments) const { return run("ray-tracing-image", arguments); }

    std::ptrdiff_t filesInFolder() const { return std::distance(fs::directory_iterator(folder_), {}); }
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
    const auto result = tool({"diff", "brighter.pfm", "reference.exr"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_NEAR(figure(result.out, "mse"), 0.0625, 1e-6);
    EXPECT_NEAR(figure(result.out, "rmse"), 0.25, 1e-6);
    EXPECT_NEAR(figure(result.out, "mae"), 0.25, 1e-6);
    EXPECT_NEAR(figure(result.out, "max"), 0.25, 1e-6);
    double relative = 0;
    for (int i = 0; i < 16 * 9 * 3; ++i) relative += 0.0625 / (std::pow(i % 10 / 16.0, 2) + 0.01) / (16 * 9 * 3);
    EXPECT_NEAR(figure(result.out, "relmse"), relative, 1e-4);
    EXPECT_TRUE(figure(result.out, "psnr") > 10 && figure(result.out, "psnr") < 20);
    EXPECT_TRUE(figure(result.out, "flip") > 0.1 && figure(result.out, "flip") < 0.9);
    EXPECT_EQ(figure(tool({"diff", "reference.exr", "reference.exr"}).out, "flip"), 0);
}

TEST_F(ImageTool, DiffComparesWithTheLimit) {
    const auto code = [&](const std::string& metric, const std::string& max) {
        return tool({"diff", "brighter.pfm", "reference.exr", "--metric", metric, "--max", max}).exitCode;
    };
    EXPECT_EQ(code("mse", "0.063"), 0);
    EXPECT_EQ(code("mse", "0.062"), 5);
    EXPECT_EQ(code("rmse", "0.062"), 5);
    EXPECT_EQ(code("mae", "0.26"), 0);
    EXPECT_EQ(code("relmse", "1e9"), 0);
    EXPECT_EQ(code("relmse", "0"), 5);
    EXPECT_EQ(code("flip", "1"), 0);
    EXPECT_EQ(code("flip", "0.1"), 5);
    EXPECT_EQ(code("psnr", "5"), 0); // at least 5 dB
    EXPECT_EQ(code("psnr", "50"), 5);
    EXPECT_EQ(tool({"diff", "brighter.pfm", "reference.exr", "--max", "0.0624"}).exitCode, 5);
    EXPECT_EQ(tool({"diff", "small.exr", "small.exr", "--max", "0", "--metric", "psnr"}).exitCode, 0);
    const auto one = tool({"diff", "brighter.pfm", "reference.exr", "--metric", "mae"});
    EXPECT_EQ(one.out, "mae 0.25\n");
}

TEST_F(ImageTool, DiffWritesAHeatMap) {
    // Also when the images differ too much.
    EXPECT_EQ(tool({"diff", "brighter.pfm", "reference.exr", "--max", "0", "--output", "heat.png"}).exitCode, 5);
    const image::Image heat = image::readImage(path("heat.png"));
    EXPECT_EQ(heat.width, 16u);
    EXPECT_EQ(heat.height, 9u);
}

TEST_F(ImageTool, ConvertsBetweenFormats) {
    EXPECT_EQ(tool({"convert", "reference.exr", "copy.pfm"}).exitCode, 0);
    EXPECT_EQ(image::readImage(path("copy.pfm")).data, image::readImage(path("reference.exr")).data);
    EXPECT_EQ(tool({"convert", "reference.exr", "shown.png"}).exitCode, 0);
    // sRGB-encoded and decoded again: off by half a level, at most 1/255 * 2.4 / 2
    const auto shown = tool({"diff", "shown.png", "reference.exr"});
    EXPECT_LT(figure(shown.out, "max"), 0.0048);
    EXPECT_EQ(tool({"convert", "reference.exr", "two.png", "--exposure", "1", "--tonemap", "reinhard"}).exitCode, 0);
    EXPECT_TRUE(failsWith(tool({"convert", "reference.exr", "two.exr", "--exposure", "1"}), 2, ".png only"));
    EXPECT_TRUE(failsWith(tool({"convert", "reference.exr", "two.png", "--tonemap", "film"}), 2, "reinhard"));
}

TEST_F(ImageTool, InfoDescribes) {
    image::writeImage(path("forged.exr"), image::Image(4, 4), "x\nmin -1\x1b[2J");
    const std::string forged = tool({"info", "forged.exr"}).out;
    EXPECT_NE(forged.find("\nrender x\\nmin -1\\x1b[2J\n"), std::string::npos) << forged;
    const auto result = tool({"info", "reference.exr"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_NE(result.out.find("size 16 9\nchannels 3\nmin 0\nmax 0.5625\nmean "), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("\nnonfinite 0\n"), std::string::npos) << result.out;
}

TEST_F(ImageTool, WarnsOfPartsOnStandardError) {
    writeFile("parts.exr", exrFileOfParts({image::Image(4, 4), image::Image(2, 2)}));
    const auto info = tool({"info", "parts.exr"});
    EXPECT_EQ(info.exitCode, 0);
    EXPECT_EQ(info.out.rfind("size 4 4\n", 0), 0u) << info.out;
    EXPECT_EQ(info.err,
              "ray-tracing-image: warning: parts.exr: of several parts the first is read, \"a\"; left out: \"b\"\n");
    EXPECT_EQ(tool({"diff", "parts.exr", "small.exr", "--max", "0"}).exitCode, 0);
    EXPECT_EQ(tool({"info", "small.exr"}).err, "");
}

TEST_F(ImageTool, FiltersAFilmThatWasKept) {
    image::Film film({8, 8, 2});
    image::Film::TileBlock block;
    for (std::uint32_t replicate = 0; replicate < 2; ++replicate) {
        film.begin(0, replicate, block);
        block.count = image::Film::kBlock;
        for (float& value : block.sum) value = 0.25f * image::Film::kBlock;
        film.commit(0, replicate, block);
    }
    image::writeCheckpoint(folder_ / "kept.rtc", nlohmann::json::object(), film);
    const auto result = tool({"denoise", "kept.rtc", "-o", "kept.pfm"});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(result.out.rfind("estimated_relmse ", 0), 0u) << result.out;
    for (const float value : image::readImage(folder_ / "kept.pfm").data) EXPECT_NEAR(value, 0.25f, 1e-4f);
    image::writeCheckpoint(folder_ / "one.rtc", nlohmann::json::object(), image::Film({8, 8, 1}));
    EXPECT_TRUE(failsWith(tool({"denoise", "one.rtc", "-o", "kept.pfm"}), 3, "replicates is 1"));
    image::writeCheckpoint(folder_ / "empty.rtc", nlohmann::json::object(), image::Film({8, 8, 2}));
    EXPECT_TRUE(failsWith(tool({"denoise", "empty.rtc", "-o", "kept.pfm"}), 3, "no samples"));
    EXPECT_TRUE(failsWith(tool({"denoise", "none.rtc", "-o", "kept.pfm"}), 3, "none.rtc"));
    EXPECT_TRUE(failsWith(tool({"denoise", "small.exr", "-o", "kept.pfm"}), 3, "small.exr"));
    EXPECT_TRUE(failsWith(tool({"denoise", "kept.rtc", "-o", "kept.gif"}), 2, "allowed: .png, .exr, .hdr, .pfm"));
    EXPECT_TRUE(failsWith(tool({"denoise", "kept.rtc", "-o", "none/kept.pfm"}), 1, "none"));
    EXPECT_TRUE(failsWith(tool({"denoise", "kept.rtc"}), 2, "--output"));
}

TEST_F(ImageTool, HelpAndVersion) {
    EXPECT_EQ(tool({"--help"}).exitCode, 0);
    EXPECT_NE(tool({"--help"}).out.find("convert"), std::string::npos);
    EXPECT_NE(tool({"diff", "--help"}).out.find("--metric"), std::string::npos);
    EXPECT_EQ(tool({"--version"}).out.rfind("ray-tracing-image ", 0), 0u);
}

TEST_F(ImageTool, WrongUseExitsWith2) {
    EXPECT_TRUE(failsWith(tool({}), 2, "diff, info, convert, denoise, merge, probe or paths"));
    EXPECT_TRUE(failsWith(tool({"paint"}), 2, "paint"));
    EXPECT_TRUE(failsWith(tool({"diff", "reference.exr"}), 2, "B"));
    EXPECT_TRUE(failsWith(tool({"diff", "small.exr", "small.exr", "--metric", "ssim"}), 2, "mse"));
    EXPECT_TRUE(failsWith(tool({"diff", "small.exr", "small.exr", "--max", "little"}), 2, "little"));
    EXPECT_TRUE(failsWith(tool({"diff", "small.exr", "small.exr", "--max", "nan"}), 2, "--max"));
    EXPECT_TRUE(failsWith(tool({"diff", "small.exr", "small.exr", "--output", "heat.gif"}), 2, ".exr"));
    EXPECT_TRUE(failsWith(tool({"convert", "reference.exr", "out.jpg"}), 2, "allowed: .png, .exr, .hdr, .pfm"));
    EXPECT_TRUE(failsWith(tool({"info", "small.exr", "--loud"}), 2, "--loud"));
}

TEST_F(ImageTool, BadInputExitsWith3) {
    EXPECT_TRUE(failsWith(tool({"info", "none.exr"}), 3, "none.exr"));
    EXPECT_TRUE(failsWith(tool({"info", ""}), 3, "allowed"));
    EXPECT_TRUE(failsWith(tool({"info", "a\x1b[2J\n.exr"}), 3, "a\\x1b[2J\\n.exr"));
    EXPECT_LT(tool({"info", std::string(100'000, 'a')}).err.size(), 1500u);
    EXPECT_TRUE(failsWith(tool({"diff", "small.exr", "reference.exr"}), 3, "4x4"));
    EXPECT_TRUE(failsWith(tool({"convert", "none.pfm", "out.png"}), 3, "none.pfm"));
    fs::resize_file(path("reference.exr"), 500);
    EXPECT_TRUE(failsWith(tool({"diff", "reference.exr", "brighter.pfm"}), 3, "truncated"));
    writeFile("nan.pfm", std::string("Pf\n1 1\n-1.0\n\0\0\xc0\x7f", 16));
    EXPECT_TRUE(failsWith(tool({"diff", "nan.pfm", "nan.pfm"}), 3, "nan.pfm: a value of pixel (0, 0) is not finite"));
}

TEST_F(ImageTool, FailingOutputExitsWith1AndLeavesNothing) {
    const auto before = filesInFolder();
    EXPECT_TRUE(failsWith(tool({"convert", "small.exr", "no/such/folder.png"}), 1, "folder.png"));
    fs::create_directory(path("taken.png"));
    EXPECT_TRUE(failsWith(tool({"convert", "small.exr", "taken.png"}), 1, "taken.png"));
    EXPECT_EQ(filesInFolder(), before + 1);
}

TEST_F(ImageTool, FullDiskExitsWith1) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "no device that is always full";
    fs::create_symlink("/dev/full", folder_ / "full.exr");
    EXPECT_TRUE(failsWith(tool({"convert", "reference.exr", "full.exr"}), 1, "full.exr: No space left"));
}

} // namespace
} // namespace rt::test
