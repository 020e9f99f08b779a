// BMP files whose rows begin with the upper one, and those in runs, against the pixels they were made of.
#include <random>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Image/Codecs.h"

namespace rt::image {
namespace {

std::string littleEndian(std::uint32_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> 8 * i & 255);
    return text;
}

constexpr std::uint32_t kRle8 = 1, kRle4 = 2;

// Colour i of the palette is (i, 255 - i, 7 i).
std::string bmpFile(std::int32_t width, std::int32_t height, std::uint32_t bits, std::uint32_t compression,
                    const std::string& pixels) {
    const std::uint32_t colors = bits <= 8 ? 1u << bits : 0;
    const std::uint32_t pixelsAt = 54 + 4 * colors;
    std::string bytes = "BM" + littleEndian(pixelsAt + static_cast<std::uint32_t>(pixels.size()), 4) +
                        littleEndian(0, 4) + littleEndian(pixelsAt, 4) + littleEndian(40, 4) +
                        littleEndian(static_cast<std::uint32_t>(width), 4) +
                        littleEndian(static_cast<std::uint32_t>(height), 4) + littleEndian(1, 2) +
                        littleEndian(bits, 2) + littleEndian(compression, 4) +
                        littleEndian(static_cast<std::uint32_t>(pixels.size()), 4) + std::string(16, '\0');
    for (std::uint32_t i = 0; i < colors; ++i)
        bytes += littleEndian(7 * i & 255, 1) + littleEndian(255 - i, 1) + littleEndian(i, 2);
    return bytes + pixels;
}

Texels decodedBmp(const std::string& bytes) {
    return decodeTexels(std::as_bytes(std::span(bytes)), std::string("a.bmp"));
}

std::string bmpErrorOf(const std::string& bytes) {
    try {
        decodedBmp(bytes);
    } catch (const InputError& e) {
        return e.what();
    }
    return {};
}

TEST(ImageBmp, RowsFromTheTop) {
    const std::string upper = "\1\2\3\4\5\6", lower = "\7\10\11\12\13\14", fill(2, '\0');
    const Texels down = decodedBmp(bmpFile(2, -2, 24, 0, upper + fill + lower + fill));
    const Texels up = decodedBmp(bmpFile(2, 2, 24, 0, lower + fill + upper + fill));
    EXPECT_EQ(down.width, 2u);
    EXPECT_EQ(down.height, 2u);
    EXPECT_EQ(down.srgb8, up.srgb8);
    EXPECT_EQ(down.srgb8, (std::vector<std::uint8_t>{3, 2, 1, 6, 5, 4, 9, 8, 7, 12, 11, 10}));
    const std::string cut = bmpFile(2, -2, 24, 0, upper);
    EXPECT_EQ(texelCount(std::as_bytes(std::span(cut))), 4u);
    EXPECT_NE(bmpErrorOf(bmpFile(2, -0x7fffffff - 1, 24, 0, upper)), "");
}

// Runs, and in between pixels as they are, of random lengths.
std::string encodeRuns(const std::vector<std::uint8_t>& indices, std::size_t width, bool halves,
                       std::minstd_rand& random) {
    std::string bytes;
    const auto pack = [&](const std::uint8_t* first, std::size_t count) {
        std::string packed;
        for (std::size_t i = 0; i < count; ++i) {
            if (!halves)
                packed += static_cast<char>(first[i]);
            else if (i % 2 == 0)
                packed += static_cast<char>(first[i] << 4);
            else
                packed.back() = static_cast<char>(packed.back() | first[i]);
        }
        return packed;
    };
    for (std::size_t row = indices.size() / width; row-- > 0;) {
        const std::uint8_t* at = &indices[row * width];
        for (std::size_t left = width; left > 0;) {
            const std::size_t absolute = std::min<std::size_t>(left, 3 + random() % 30);
            if (absolute >= 3 && random() % 2 == 0) {
                std::string packed = pack(at, absolute);
                packed.resize((packed.size() + 1) / 2 * 2);
                bytes += std::string(1, '\0') + static_cast<char>(absolute) + packed;
                at += absolute;
                left -= absolute;
                continue;
            }
            std::size_t run = 1; // two colours in turn, of RLE4
            const std::size_t period = halves ? 2 : 1;
            while (run < left && run < 255 && (run < period || at[run] == at[run - period])) ++run;
            std::string packed = pack(at, std::min<std::size_t>(run, period));
            bytes += static_cast<char>(run) + packed;
            at += run;
            left -= run;
        }
        bytes += std::string(2, '\0');
    }
    return bytes + std::string("\0\1", 2);
}

TEST(ImageBmp, RunsHoldThePixelsTheyWereMadeOf) {
    std::minstd_rand random(5);
    for (const bool halves : {false, true}) {
        for (const std::size_t width : {1u, 2u, 37u, 300u}) {
            std::vector<std::uint8_t> indices(width * 23);
            for (std::size_t i = 0; i < indices.size(); ++i)
                indices[i] = i > 0 && random() % 4 != 0 ? indices[i - 1]
                                                        : static_cast<std::uint8_t>(random() % (halves ? 16 : 256));
            const Texels texels =
                decodedBmp(bmpFile(static_cast<std::int32_t>(width), 23, halves ? 4 : 8, halves ? kRle4 : kRle8,
                                   encodeRuns(indices, width, halves, random)));
            ASSERT_EQ(texels.width, width);
            ASSERT_EQ(texels.height, 23u);
            for (std::size_t i = 0; i < indices.size(); ++i) {
                ASSERT_EQ(texels.srgb8[3 * i], indices[i]) << i;
                ASSERT_EQ(texels.srgb8[3 * i + 1], 255 - indices[i]) << i;
                ASSERT_EQ(texels.srgb8[3 * i + 2], 7 * indices[i] & 255) << i;
            }
        }
    }
}

// Two to the right and one up.
TEST(ImageBmp, WhatIsLeftOutHasTheFirstColour) {
    const Texels texels = decodedBmp(bmpFile(4, 2, 8, kRle8, std::string("\1\5\0\2\2\1\1\6\0\1", 10)));
    std::vector<std::uint8_t> indices;
    for (std::size_t i = 0; i < texels.srgb8.size(); i += 3) indices.push_back(texels.srgb8[i]);
    EXPECT_EQ(indices, (std::vector<std::uint8_t>{0, 0, 0, 6, 5, 0, 0, 0}));
}

TEST(ImageBmp, RunsMayFillARowToFourBytes) {
    const Texels plain = decodedBmp(bmpFile(3, 2, 8, kRle8, std::string("\3\5\0\0\3\6\0\1", 8)));
    const Texels filled = decodedBmp(bmpFile(3, 2, 8, kRle8, std::string("\4\5\0\0\3\6\1\7\0\1", 10)));
    EXPECT_EQ(filled.srgb8, plain.srgb8);
    EXPECT_NE(bmpErrorOf(bmpFile(3, 2, 8, kRle8, std::string("\5\5\0\1", 4))), "");
}

TEST(ImageBmp, DamagedRunsAreRefused) {
    EXPECT_EQ(bmpErrorOf(bmpFile(4, 2, 8, kRle8, std::string("\5\5\0\1", 4))),
              "a.bmp: damaged BMP file: a run does not fit its row");
    EXPECT_EQ(bmpErrorOf(bmpFile(4, 2, 8, kRle8, std::string("\4\5\0\0\1", 5))), "a.bmp: truncated BMP file");
    EXPECT_EQ(bmpErrorOf(bmpFile(4, 2, 8, kRle8, std::string("\0\2\0\7\1\1\0\1", 8))),
              "a.bmp: damaged BMP file: a run does not fit its row");
    EXPECT_EQ(bmpErrorOf(bmpFile(4, 2, 4, kRle8, std::string("\0\1", 2))),
              "a.bmp: damaged BMP file: 4 bits a pixel in runs of 8");
    EXPECT_NE(bmpErrorOf(bmpFile(60000, 60000, 8, kRle8, std::string("\0\1", 2))).find("60000x60000"),
              std::string::npos);
    EXPECT_NE(bmpErrorOf(bmpFile(4, -2, 8, kRle8, std::string("\0\1", 2))).find("4x-2"), std::string::npos);
    const std::string whole = bmpFile(4, 2, 8, kRle8, std::string("\4\5\0\0\4\6\0\1", 8));
    EXPECT_EQ(bmpErrorOf(whole), "");
    for (std::size_t size = 0; size + 8 < whole.size(); ++size)
        EXPECT_NE(bmpErrorOf(whole.substr(0, size)), "") << size;
}

} // namespace
} // namespace rt::image
