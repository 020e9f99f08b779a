// Image files: round trips, files that others wrote, and the values that a format cannot hold.
#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Image/ImageIo.h"
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

TEST(ImageIo, HdrRoundsToNearest) {
    const test::TempFolder folder;
    Image image(100, 50);
    std::mt19937 random(5);
    for (float& value : image.data)
        value = std::ldexp(1 + static_cast<float>(random() >> 8) * 0x1p-24f, static_cast<int>(random() % 3));
    writeImage(folder / "a.hdr", image);
    const Image back = readImage(folder / "a.hdr");
    double bias = 0;
    for (std::size_t i = 0; i < image.data.size(); i += 3) {
        const float largest = std::max({image.data[i], image.data[i + 1], image.data[i + 2]});
        const float step = std::ldexp(1.0f, std::ilogb(largest) - 7); // of a mantissa of 8 bits
        for (std::size_t c = i; c < i + 3; ++c) {
            EXPECT_LE(std::abs(back.data[c] - image.data[c]), step); // half of it, but where the largest rounds up
            bias += (back.data[c] - image.data[c]) / step;
        }
    }
    const auto count = static_cast<double>(image.data.size());
    EXPECT_LT(std::abs(bias / count), 4 * std::sqrt(1.0 / 12 / count)); // rounding down would give -1/2
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
              (std::vector<float>{0, 0, 0, 1, 1, 1, 255, 1, 0}));
    EXPECT_EQ(back.data[9], 0x1.fep126f);
    EXPECT_EQ(back.data[12], 0.0f);
    EXPECT_EQ(back.data[13], 2.0f);
    EXPECT_NEAR(back.data[15], 1e-38f, 1e-38f / 128);
    EXPECT_EQ(back.data[18], 0.0f);
    EXPECT_EQ(back.data[21], 1.0f); // rounds up to the next exponent
    EXPECT_EQ(back.data[22], 0.5f);
    EXPECT_EQ(back.data[24], 1.0f);

    Image grey(2, 1, 1);
    grey.data = {3.0f, 0.25f};
    writeImage(folder / "grey.hdr", grey);
    EXPECT_EQ(readImage(folder / "grey.hdr").data, (std::vector<float>{3, 3, 3, 0.25f, 0.25f, 0.25f}));
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
    EXPECT_EQ(readImage(folder / "a.hdr").data[0], 0.0f);
}

// Written by tinyexr and stb: R = x/16, G = y/16, B = xy/256.
TEST(ImageIo, ReadsFilesOfOthers) {
    for (const std::string name :
         {"none-float.exr", "rle-half.exr", "zips-float.exr", "zip-half.exr", "zip-float.exr", "gradient.hdr"}) {
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
