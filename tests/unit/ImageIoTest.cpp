// Image files: round trips, files that others wrote, and the values that a format cannot hold.
#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <limits>
#include <png.h>
#include <random>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Error.h"
#include "Common/Image/ImageIo.h"
#include "Common/Scene/Json/SceneJson.h"
#include "tests/FileBytes.h"
#include "tests/TempFolder.h"

namespace rt::image {
namespace {

constexpr float kLargest = std::numeric_limits<float>::max();

std::filesystem::path dataFile(const std::string& name) {
    return std::filesystem::path(RT_TEST_DATA_DIR) / "images" / name;
}

std::vector<std::uint32_t> bitsOf(const Image& image) {
    std::vector<std::uint32_t> bits;
    for (const float value : image.data) bits.push_back(std::bit_cast<std::uint32_t>(value));
    return bits;
}

Image makeImage(std::uint32_t width, std::uint32_t height, std::uint32_t channels) {
    Image image(width, height, channels);
    std::mt19937 random(3);
    for (float& value : image.data)
        value = std::ldexp(static_cast<float>(random() >> 8), static_cast<int>(random() % 60) - 50);
    const float special[] = {0.0f, -0.0f, 1e-45f, -1.5f, kLargest, -kLargest, 1.17549435e-38f};
    std::copy(std::begin(special), std::end(special), image.data.begin());
    return image;
}

TEST(ImageIo, FloatFormatsAreExact) {
    const test::TempFolder folder;
    for (const std::string name : {"a.exr", "a.pfm", "A.EXR", "b.c.Pfm"}) {
        for (const std::uint32_t channels : {1u, 3u}) {
            for (const auto& [width, height] : {std::pair{37u, 19u}, std::pair{7u, 1u}, std::pair{1u, 33u}}) {
                const Image image = makeImage(width, height, channels);
                writeImage(folder / name, image);
                const Image back = readImage(folder / name);
                EXPECT_EQ(back.width, width);
                EXPECT_EQ(back.height, height);
                EXPECT_EQ(back.channels, channels);
                EXPECT_EQ(bitsOf(back), bitsOf(image)) << name;
            }
        }
    }
}

TEST(ImageIo, PngHoldsAll256Levels) {
    const test::TempFolder folder;
    Image image(16, 16);
    for (std::size_t i = 0; i < 256; ++i) {
        const double encoded = double(i) / 255;
        const double linear = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
        for (std::size_t c = 0; c < 3; ++c) image.data[i * 3 + c] = static_cast<float>(linear);
    }
    writeImage(folder / "levels.png", image);
    const Texels texels = loadTexels(folder / "levels.png");
    ASSERT_EQ(texels.width, 16u);
    ASSERT_TRUE(texels.linear.empty());
    for (std::size_t i = 0; i < 768; ++i) ASSERT_EQ(texels.srgb8[i], i / 3);
    const Image back = readImage(folder / "levels.png");
    for (std::size_t i = 0; i < 768; ++i) EXPECT_NEAR(back.data[i], image.data[i], 1e-6f);
}

// An encoder of 16 bits a channel, sRGB as they are, for the test alone.
std::string encodePng16(std::uint32_t width, std::uint32_t height, int colorType,
                        const std::vector<std::uint16_t>& values) {
    std::string png;
    png_structp writer = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(writer);
    png_set_write_fn(
        writer, &png,
        [](png_structp p, png_bytep data, png_size_t size) {
            static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<const char*>(data), size);
        },
        [](png_structp) {});
    png_set_IHDR(writer, info, width, height, 16, colorType, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(writer, info);
    std::vector<png_byte> row(2 * values.size() / height);
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::size_t i = 0; i < row.size() / 2; ++i) {
            const std::uint16_t value = values[y * row.size() / 2 + i];
            row[2 * i] = static_cast<png_byte>(value >> 8);
            row[2 * i + 1] = static_cast<png_byte>(value & 255);
        }
        png_write_row(writer, row.data());
    }
    png_write_end(writer, nullptr);
    png_destroy_write_struct(&writer, &info);
    return png;
}

TEST(ImageIo, PngOf16BitsKeepsThem) {
    const test::TempFolder folder;
    std::vector<std::uint16_t> values(3 * 256 * 4);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<std::uint16_t>(i * 65535 / (values.size() - 1));
    std::ofstream(folder / "rgb.png", std::ios::binary) << encodePng16(256, 4, PNG_COLOR_TYPE_RGB, values);
    const Texels texels = loadTexels(folder / "rgb.png");
    EXPECT_EQ(texels.srgb16, values);
    EXPECT_TRUE(texels.srgb8.empty() && texels.linear.empty());
    const Image image = readImage(folder / "rgb.png");
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double encoded = values[i] / 65535.0;
        const double linear = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
        EXPECT_NEAR(image.data[i], linear, 1e-6);
    }
    std::ofstream(folder / "grey.png", std::ios::binary) << encodePng16(2, 1, PNG_COLOR_TYPE_GRAY, {1, 65534});
    EXPECT_EQ(loadTexels(folder / "grey.png").srgb16, (std::vector<std::uint16_t>{1, 1, 1, 65534, 65534, 65534}));
    std::ofstream(folder / "rgba.png", std::ios::binary)
        << encodePng16(1, 1, PNG_COLOR_TYPE_RGB_ALPHA, {0x1234, 0x5678, 0x9abc, 0x80ff});
    const Texels rgba = loadTexels(folder / "rgba.png");
    EXPECT_EQ(rgba.srgb16, (std::vector<std::uint16_t>{0x1234, 0x5678, 0x9abc}));
    EXPECT_EQ(rgba.alpha16, (std::vector<std::uint16_t>{0x80ff}));
    EXPECT_TRUE(rgba.srgb8.empty() && rgba.alpha8.empty());
}

// From the file to what kernels read: colours decoded, opacity as it is, neither rounded to 8 bits.
TEST(ImageIo, TexturesOf16BitsKeepColoursAndOpacity) {
    const test::TempFolder folder;
    const std::vector<std::uint16_t> values = {0x1234, 0x5678, 0x9abc, 0x80ff, 0xffff, 0, 1, 0x0003};
    std::ofstream(folder / "a.png", std::ios::binary) << encodePng16(2, 1, PNG_COLOR_TYPE_RGB_ALPHA, values);
    const auto compiled = app::compile(scene::parseScene(
                                           R"({"textures": {"t": {"type": "image", "file": "a.png"}},
                "materials": {"m": {"type": "principled", "base_color": "t", "roughness": 1,
                                    "opacity": {"texture": "t", "channel": "alpha"}}},
                "objects": [{"type": "sphere", "center": [0, 0, -5], "radius": 1, "material": "m"}]})",
                                           "a.json", folder.path()),
                                       false);
    ASSERT_EQ(compiled->images.size(), 1u);
    EXPECT_EQ(compiled->images[0].format, shared::kTexelLinearF32A);
    ASSERT_EQ(compiled->texels.size(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double encoded = values[i] / 65535.0;
        const double linear = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
        EXPECT_NEAR(std::bit_cast<float>(compiled->texels[i]), i % 4 == 3 ? encoded : linear, 1e-6) << i;
    }
    EXPECT_TRUE(shared::has(compiled->features, shared::kFeatureOpacity));
}

// Content of a chunk that stands between header and rows; empty: there is none.
std::string chunkOf(const std::string& png, const std::string& type) {
    const std::size_t at = png.find(type);
    if (at == std::string::npos || at > png.find("IDAT")) return {};
    const auto length = static_cast<unsigned char>(png[at - 1]);
    return png.substr(at + 4, length);
}

TEST(ImageIo, PngSaysThatItIsSrgb) {
    const test::TempFolder folder;
    writeImage(folder / "a.png", Image(2, 1), "text");
    const std::string png = test::bytesOfFile(folder / "a.png");
    EXPECT_EQ(chunkOf(png, "sRGB"), std::string(1, '\0')) << "perceptual intent";
    // What stands for it where sRGB is unknown, times 100 000: 1 / 2.2, and white, red, green and blue of Rec. 709.
    const auto numbers = [](const std::vector<std::uint32_t>& values) {
        std::string bytes;
        for (const std::uint32_t v : values)
            for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(v >> shift & 255u);
        return bytes;
    };
    EXPECT_EQ(chunkOf(png, "gAMA"), numbers({45455}));
    EXPECT_EQ(chunkOf(png, "cHRM"), numbers({31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000}));
}

TEST(ImageIo, PngClampsAndRounds) {
    const test::TempFolder folder;
    const auto linear = [](double level) { return float(std::pow((level / 255 + 0.055) / 1.055, 2.4)); };
    Image image(5, 1, 1);
    image.data = {-1.0f, 7.0f, linear(127.51), linear(128.49), linear(128.51)};
    writeImage(folder / "grey.png", image);
    const std::vector<std::uint8_t> texels = loadTexels(folder / "grey.png").srgb8;
    const std::uint8_t expected[] = {0, 255, 128, 128, 129};
    for (std::size_t i = 0; i < texels.size(); ++i) EXPECT_EQ(texels[i], expected[i / 3]) << i;
}

// The convention of the format's own library: mantissas are cut off, and stand for the middle of what they were cut
// from. Both directions against it, computed here: without bias, and never off by more than half a step.
TEST(ImageIo, HdrMantissasAreRadiances) {
    const test::TempFolder folder;
    constexpr std::size_t kPixels = 5000;
    Image image(100, 50);
    std::mt19937 random(5);
    for (float& value : image.data)
        value = std::ldexp(1 + static_cast<float>(random() >> 8) * 0x1p-24f, static_cast<int>(random() % 3));
    writeImage(folder / "a.hdr", image);
    const std::string ours = test::bytesOfFile(folder / "a.hdr");
    const std::string header = ours.substr(0, ours.size() - 4 * kPixels);

    std::string theirs = header;
    double writing = 0, reading = 0, withoutHalf = 0; // in steps
    for (std::size_t i = 0; i < kPixels; ++i) {
        const float* rgb = &image.data[3 * i];
        int exponent = 0;
        std::frexp(std::max({rgb[0], rgb[1], rgb[2]}), &exponent);
        for (std::size_t c = 0; c < 3; ++c) {
            const double exact = std::ldexp(double(rgb[c]), 8 - exponent);
            const double written = static_cast<unsigned char>(ours[header.size() + 4 * i + c]);
            EXPECT_LE(std::abs(written + 0.5 - exact), 0.5) << i;
            writing += written + 0.5 - exact;
            withoutHalf += written - exact;
            theirs += static_cast<char>(static_cast<unsigned char>(exact));
        }
        EXPECT_EQ(static_cast<unsigned char>(ours[header.size() + 4 * i + 3]), exponent + 128);
        theirs += static_cast<char>(exponent + 128);
    }
    std::ofstream(folder / "theirs.hdr", std::ios::binary) << theirs;
    const Image back = readImage(folder / "theirs.hdr");
    for (std::size_t i = 0; i < kPixels; ++i) {
        const float* rgb = &image.data[3 * i];
        const double step = std::ldexp(1.0, std::ilogb(std::max({rgb[0], rgb[1], rgb[2]})) - 7);
        for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
            const double error = (double(back.data[c]) - double(image.data[c])) / step;
            EXPECT_LE(std::abs(error), 0.5) << c;
            reading += error;
        }
    }
    constexpr double kCount = 3 * kPixels;
    const double fourSigma = 4 * std::sqrt(1.0 / 12 / kCount); // of errors uniform over a step
    EXPECT_LT(std::abs(writing / kCount), fourSigma);
    EXPECT_LT(std::abs(reading / kCount), fourSigma);
    EXPECT_LT(std::abs(withoutHalf / kCount + 0.5), fourSigma) << "the bias that the test would see";
}

TEST(ImageIo, HdrExtremes) {
    const test::TempFolder folder;
    Image image(9, 1);
    image.data = {0, 0,     0,      1, 1, 1,      255, 1, 0,      kLargest, 1, 1,      -1,
                  2, -0.0f, 1e-38f, 0, 0, 1e-44f, 0,   0, 0.999f, 0.5f,     0, 0.9985f};
    image.data.resize(27);
    writeImage(folder / "a.hdr", image);
    const Image back = readImage(folder / "a.hdr");
    EXPECT_EQ(std::vector<float>(back.data.begin(), back.data.begin() + 9),
              (std::vector<float>{0, 0, 0, 128.5f / 128, 128.5f / 128, 128.5f / 128, 255.5f, 1.5f, 0.5f}));
    EXPECT_EQ(back.data[9], 0x1.ffp126f);
    EXPECT_EQ(back.data[12], 0.5f / 64); // negative: 0
    EXPECT_EQ(back.data[13], 128.5f / 64);
    EXPECT_NEAR(back.data[15], 1e-38f, 1e-38f / 256);
    EXPECT_EQ(back.data[18], 0.0f);
    EXPECT_EQ(back.data[21], 255.5f / 256);
    EXPECT_EQ(back.data[22], 128.5f / 256);
    EXPECT_EQ(back.data[24], 255.5f / 256);
    writeImage(folder / "again.hdr", back);
    EXPECT_EQ(readImage(folder / "again.hdr").data, back.data) << "what was read is written as it was";

    Image grey(2, 1, 1);
    grey.data = {3.0f, 0.25f};
    writeImage(folder / "grey.hdr", grey);
    const float three = 192.5f / 64, quarter = 128.5f / 512;
    EXPECT_EQ(readImage(folder / "grey.hdr").data,
              (std::vector<float>{three, three, three, quarter, quarter, quarter}));
}

TEST(ImageIo, WritesNothingThatIsNotFinite) {
    const test::TempFolder folder;
    Image image(4, 1);
    image.data = {NAN, INFINITY, -INFINITY, 1, 2, 3, 4, 5, 6, NAN, 0, 0};
    for (const std::string name : {"a.exr", "a.pfm"}) {
        writeImage(folder / name, image);
        EXPECT_EQ(readImage(folder / name).data,
                  (std::vector<float>{0, kLargest, -kLargest, 1, 2, 3, 4, 5, 6, 0, 0, 0}));
    }
    writeImage(folder / "a.png", image);
    EXPECT_EQ(loadTexels(folder / "a.png").srgb8[0], 0);
    EXPECT_EQ(loadTexels(folder / "a.png").srgb8[1], 255);
    writeImage(folder / "a.hdr", image);
    EXPECT_EQ(readImage(folder / "a.hdr").data[0], 0x1p118f); // half a step beside an infinity
}

// Written by tinyexr and stb: R = x/16, G = y/16, B = xy/256.
TEST(ImageIo, ReadsFilesOfOthers) {
    for (const std::string name : {"none-float.exr", "rle-half.exr", "zips-float.exr", "zip-half.exr", "zip-float.exr",
                                   "piz-half.exr", "gradient.hdr"}) {
        const Image image = readImage(dataFile(name));
        ASSERT_EQ(image.width, 21u) << name;
        ASSERT_EQ(image.height, 19u) << name;
        ASSERT_EQ(image.channels, 3u) << name;
        const float tolerance = name == "gradient.hdr" ? 2.0f / 256 : 0.0f;
        for (std::uint32_t y = 0; y < 19; ++y) {
            for (std::uint32_t x = 0; x < 21; ++x) {
                EXPECT_NEAR(image.pixel(x, y)[0], float(x) / 16, tolerance) << name << ' ' << x << ' ' << y;
                EXPECT_NEAR(image.pixel(x, y)[1], float(y) / 16, tolerance) << name << ' ' << x << ' ' << y;
                EXPECT_NEAR(image.pixel(x, y)[2], float(x * y) / 256, tolerance) << name << ' ' << x << ' ' << y;
            }
        }
    }
}

TEST(ImageIo, ReadsBigEndianPfm) {
    const test::TempFolder folder;
    std::ofstream(folder / "a.pfm", std::ios::binary)
        << std::string("Pf\n1 2\n1.0\n\x3f\x80\0\0\xc0\x20\0\0", 19); // 1 below -2.5: rows come from the bottom
    const Image image = readImage(folder / "a.pfm");
    EXPECT_EQ(image.channels, 1u);
    EXPECT_EQ(image.data, (std::vector<float>{-2.5f, 1.0f}));
}

TEST(ImageIo, TexelsOfFloatFilesAreRgbAndNotNegative) {
    const test::TempFolder folder;
    Image image(2, 1, 1);
    image.data = {-1.0f, 0.75f};
    writeImage(folder / "a.exr", image);
    const Texels texels = loadTexels(folder / "a.exr");
    EXPECT_TRUE(texels.srgb8.empty());
    EXPECT_EQ(texels.linear, (std::vector<float>{0, 0, 0, 0.75f, 0.75f, 0.75f}));

    std::ofstream(folder / "nan.pfm", std::ios::binary) << std::string("Pf\n1 1\n-1.0\n\0\0\xc0\x7f", 16);
    EXPECT_TRUE(std::isnan(readImage(folder / "nan.pfm").data[0]));
    EXPECT_THROW(loadTexels(folder / "nan.pfm"), InputError);
}

TEST(ImageIo, ReadsJpeg) {
    const Texels texels = loadTexels(dataFile("gradient.jpg")); // (12 x, 13 y, 128), quality 90
    ASSERT_EQ(texels.width, 21u);
    ASSERT_EQ(texels.height, 19u);
    for (std::size_t y = 0; y < 19; ++y) {
        for (std::size_t x = 0; x < 21; ++x) {
            EXPECT_NEAR(texels.srgb8[(y * 21 + x) * 3 + 1], 13.0 * double(y), 12);
            EXPECT_NEAR(texels.srgb8[(y * 21 + x) * 3 + 2], 128.0, 24);
        }
    }
}

TEST(ImageIo, TheExtensionDecides) {
    const test::TempFolder folder;
    const Image image(2, 2);
    for (const std::string name : {"a", "a.gif", "a.jpg", "a.", ".png"}) {
        try {
            writeImage(folder / name, image);
            ADD_FAILURE() << name;
        } catch (const UsageError& e) {
            EXPECT_NE(std::string(e.what()).find(".png, .exr, .hdr, .pfm)"), std::string::npos) << e.what();
        }
        EXPECT_THROW(checkWritable(folder / name), UsageError);
        EXPECT_FALSE(std::filesystem::exists(folder / name));
    }
    EXPECT_THROW(readImage(folder / "a.gif"), InputError);
    EXPECT_TRUE(isDisplayReferred("x.PNG"));
    EXPECT_FALSE(isDisplayReferred("x.exr"));
}

} // namespace
} // namespace rt::image
