// OpenEXR files of every kind that others write, and ours as others read them.
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>
#include <algorithm>
#include <cmath>
#include <new>
#include <ostream>
#include <sstream>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Core/Log.h"
#include "Common/Image/Codecs.h"
#include "tests/TempFolder.h"
#include "tests/unit/ExrFiles.h"

namespace rt::image {
namespace {

using test::exrFile;
using test::ExrKind;

struct Compression {
    const char* name;
    Imf::Compression value;
    bool isLossyForHalf = false, isLossyForFloat = false;
};

constexpr Compression kCompressions[] = {{"none", Imf::NO_COMPRESSION},
                                         {"RLE", Imf::RLE_COMPRESSION},
                                         {"ZIPS", Imf::ZIPS_COMPRESSION},
                                         {"ZIP", Imf::ZIP_COMPRESSION},
                                         {"PIZ", Imf::PIZ_COMPRESSION},
                                         {"PXR24", Imf::PXR24_COMPRESSION, false, true},
                                         {"B44", Imf::B44_COMPRESSION, true, false},
                                         {"B44A", Imf::B44A_COMPRESSION, true, false},
                                         {"DWAA", Imf::DWAA_COMPRESSION, true, true},
                                         {"DWAB", Imf::DWAB_COMPRESSION, true, true}};

// Smooth, as lossy compressions want it. Whole numbers are exact in every type, thirds fill a float's digits.
Image makeGradient(std::uint32_t width, std::uint32_t height, bool isWhole) {
    Image image(width, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            for (std::uint32_t c = 0; c < 3; ++c)
                image.pixel(x, y)[c] = float(100 + (c + 1) * x + y) / (isWhole ? 1.0f : 3.0f);
    return image;
}

Image decode(const std::string& bytes) {
    return decodeExr(std::as_bytes(std::span(bytes)), "a.exr");
}

void expectNear(const Image& image, const Image& expected, float relative, const std::string& what) {
    ASSERT_EQ(image.width, expected.width) << what;
    ASSERT_EQ(image.height, expected.height) << what;
    ASSERT_EQ(image.channels, expected.channels) << what;
    float worst = 0;
    for (std::size_t i = 0; i < image.data.size(); ++i)
        worst = std::max(worst, std::abs(image.data[i] - expected.data[i]) / std::abs(expected.data[i]));
    EXPECT_LE(worst, relative) << what;
}

// What reading the bytes prints to standard error, and the image.
std::pair<std::string, Image> decodeWithWarnings(const std::string& bytes) {
    testing::internal::CaptureStderr();
    setUpLog({"test", false, false, ""});
    Image image = decode(bytes);
    return {testing::internal::GetCapturedStderr(), std::move(image)};
}

TEST(ImageExr, EveryCompressionAndType) {
    constexpr std::uint32_t kWidth = 19, kHeight = 270; // more rows than a chunk of any compression has
    for (const Compression& compression : kCompressions) {
        for (const Imf::PixelType type : {Imf::UINT, Imf::HALF, Imf::FLOAT}) {
            const Image image = makeGradient(kWidth, kHeight, type != Imf::FLOAT);
            const bool isLossy = (type == Imf::HALF && compression.isLossyForHalf) ||
                                 (type == Imf::FLOAT && compression.isLossyForFloat);
            const Image back = decode(exrFile(image, {.type = type, .compression = compression.value}));
            expectNear(back, image, isLossy ? 0.02f : 0.0f, compression.name + std::to_string(type));
        }
    }
}

// Nothing is denser: such files are not taken for truncated ones.
TEST(ImageExr, BlackInEveryCompression) {
    const Image image(1024, 512);
    for (const Compression& compression : kCompressions)
        for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT}) {
            const Image back = decode(exrFile(image, {.type = type, .compression = compression.value}));
            EXPECT_TRUE(back.data == image.data) << compression.name;
        }
}

TEST(ImageExr, Tiles) {
    const Image image = makeGradient(37, 21, false);
    for (const Imf::LevelMode levels : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS, Imf::RIPMAP_LEVELS})
        for (const Imf::LineOrder order : {Imf::INCREASING_Y, Imf::DECREASING_Y, Imf::RANDOM_Y})
            for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION}) {
                const ExrKind kind = {.compression = compression, .lineOrder = order, .levels = levels};
                expectNear(decode(exrFile(image, kind)), image, 0,
                           std::to_string(levels) + ' ' + std::to_string(order));
            }
}

TEST(ImageExr, TheDataWindowIsTheImage) {
    const Image image = makeGradient(9, 40, false);
    for (const Imath::V2i& origin : {Imath::V2i{-5, 7}, Imath::V2i{1'000'000, -1'000'000}}) {
        expectNear(decode(exrFile(image, {.compression = Imf::PIZ_COMPRESSION, .origin = origin})), image, 0, "lines");
        expectNear(decode(exrFile(image, {.origin = origin, .levels = Imf::MIPMAP_LEVELS})), image, 0, "tiles");
    }
}

TEST(ImageExr, RowsFromTheBottom) {
    const Image image = makeGradient(9, 40, false);
    for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
        const ExrKind kind = {.compression = compression, .lineOrder = Imf::DECREASING_Y};
        expectNear(decode(exrFile(image, kind)), image, 0, std::to_string(compression));
    }
}

TEST(ImageExr, TheFirstOfSeveralParts) {
    const Image image = makeGradient(9, 5, false);
    const std::string bytes = test::exrFileOfParts({image, Image(3, 3), Image(7, 1)});
    const auto [warning, back] = decodeWithWarnings(bytes);
    expectNear(back, image, 0, "part a");
    EXPECT_NE(warning.find("a.exr: of several parts the first is read, \"a\"; left out: \"b\", \"c\""),
              std::string::npos)
        << warning;
    EXPECT_EQ(decodeWithWarnings(exrFile(image)).first, "");
}

TEST(ImageExr, ColourOrLuminance) {
    Image image(4, 2, 4);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = float(i);
    const auto [silence, colour] = decodeWithWarnings(exrFile(image, {.channels = {"A", "G", "B", "R"}}));
    EXPECT_EQ(silence, "");
    ASSERT_EQ(colour.channels, 3u);
    EXPECT_EQ(std::vector<float>(colour.pixel(1, 0), colour.pixel(2, 0)), (std::vector<float>{7, 5, 6}));

    const auto [none, luminance] = decodeWithWarnings(exrFile(image, {.channels = {"BY", "A", "Y", "R"}}));
    EXPECT_EQ(none, "");
    ASSERT_EQ(luminance.channels, 1u);
    EXPECT_EQ(luminance.data, (std::vector<float>{2, 6, 10, 14, 18, 22, 26, 30}));

    try {
        decode(exrFile(image, {.channels = {"R", "G", "Z", "left.B"}}));
        ADD_FAILURE() << "no error";
    } catch (const InputError& e) {
        EXPECT_STREQ(e.what(),
                     "a.exr: EXR file has neither channels R, G, B nor Y (it has: G, R, Z, left.B); layers: left");
    }
}

// Rows are read from the last to the first, so that each is looked for where the file's table says.
TEST(ImageExr, OursIsWholeForTheLibrary) {
    const test::TempFolder folder;
    const Image image = makeGradient(13, 7, false);
    writeImage(folder / "a.exr", image, "text");
    Imf::InputFile file((folder / "a.exr").string().c_str(), 0);
    EXPECT_TRUE(file.isComplete());
    const Imf::Header& header = file.header();
    const Imath::Box2i window({0, 0}, {12, 6});
    EXPECT_EQ(header.dataWindow(), window);
    EXPECT_EQ(header.displayWindow(), window);
    EXPECT_EQ(header.compression(), Imf::NO_COMPRESSION);
    EXPECT_EQ(header.lineOrder(), Imf::INCREASING_Y);
    EXPECT_EQ(header.pixelAspectRatio(), 1.0f);
    EXPECT_EQ(header.screenWindowCenter(), Imath::V2f(0, 0));
    EXPECT_EQ(header.screenWindowWidth(), 1.0f);
    ASSERT_NE(header.findTypedAttribute<Imf::StringAttribute>("ray-tracing"), nullptr);
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("ray-tracing").value(), "text");

    Image back(13, 7);
    Imf::FrameBuffer pixels;
    std::string channels;
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
        EXPECT_EQ(i.channel().type, Imf::FLOAT);
        channels += i.name();
        const std::size_t c = std::string("RGB").find(i.name());
        ASSERT_LT(c, 3u);
        pixels.insert(i.name(), Imf::Slice::Make(Imf::FLOAT, back.data.data() + c, window, 3 * sizeof(float)));
    }
    EXPECT_EQ(channels, "BGR");
    file.setFrameBuffer(pixels);
    for (int y = 6; y >= 0; --y) file.readPixels(y);
    EXPECT_EQ(back.data, image.data);
}

TEST(ImageExr, TextsOfOthers) {
    Imf::Header header = test::exrHeader(Image(2, 2), {});
    header.insert("ray-tracing", Imf::StringAttribute("of others"));
    header.insert("comment", Imf::StringAttribute("nothing of ours"));
    Imf::StdOSStream out;
    { const Imf::OutputFile file(out, header, 0); } // without rows, as a program that was ended leaves it
    const std::string bytes = out.str();
    EXPECT_EQ(findExrText(std::as_bytes(std::span(bytes)), "a.exr"), "of others");
    EXPECT_THROW(decode(bytes), InputError);
}

TEST(ImageExr, WritingThatFails) {
    const Image image = makeGradient(5, 4, false);
    std::ostream closed(nullptr);
    encodeExr(image, closed, "text");
    EXPECT_TRUE(closed.fail());

    const ImageRows rows(5, 4, 3, [](std::uint32_t y, std::span<float> row) {
        if (y == 2) throw std::bad_alloc();
        std::fill(row.begin(), row.end(), 1.0f);
    });
    std::ostringstream out;
    EXPECT_THROW(encodeExr(rows, out), std::bad_alloc);
}

} // namespace
} // namespace rt::image
