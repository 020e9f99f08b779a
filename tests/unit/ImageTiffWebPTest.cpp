// TIFF and WebP, written by their own libraries where the build has them, and the messages where it has not.
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Image/Codecs.h"
#include "tests/FileBytes.h"
#include "tests/TempFolder.h"

#ifdef RT_HAS_TIFF
#include <tiffio.h>
#endif
#ifdef RT_HAS_WEBP
#include <webp/encode.h>
#endif

namespace rt::image {
namespace {

std::string textureErrorOf(const std::string& bytes, const std::string& name) {
    try {
        decodeTexels(std::as_bytes(std::span(bytes)), std::filesystem::path(name));
    } catch (const InputError& e) {
        return e.what();
    }
    return {};
}

TEST(ImageTiffWebP, WhatNobodyHereReadsIsNamed) {
    EXPECT_EQ(textureErrorOf("DDS ", "a.dds").find("a.dds: DDS files are not supported (allowed: .png, "), 0u);
    EXPECT_EQ(textureErrorOf("KTX", "a.KTX2").find("a.KTX2: KTX2 files are not supported"), 0u);
    EXPECT_NE(textureErrorOf(std::string("II*\0\xff\xff\xff\xff", 8), "a.tif"), "");
    EXPECT_NE(textureErrorOf("RIFF1234WEBPVP8 ", "a.webp"), "");
}

#ifdef RT_HAS_TIFF

struct TiffKind {
    std::uint16_t bits = 8, samples = 3, format = SAMPLEFORMAT_UINT, compression = COMPRESSION_NONE;
    std::uint16_t planes = PLANARCONFIG_CONTIG;
};

constexpr std::uint32_t kTiffWidth = 19, kTiffHeight = 23;

double tiffValue(std::uint32_t x, std::uint32_t y, std::uint32_t c) {
    return (x + 2 * y + 40 * c) % 200 / 200.0;
}

template <typename T>
std::vector<std::byte> tiffRow(std::uint32_t y, std::uint32_t samples, double scale) {
    std::vector<std::byte> row;
    for (std::uint32_t x = 0; x < kTiffWidth; ++x)
        for (std::uint32_t c = 0; c < samples; ++c) {
            const T value = static_cast<T>(tiffValue(x, y, c) * scale);
            const auto bytes = std::as_bytes(std::span(&value, 1));
            row.insert(row.end(), bytes.begin(), bytes.end());
        }
    return row;
}

std::string tiffFile(const TiffKind& kind) {
    const test::TempFolder folder;
    const std::string path = (folder / "a.tif").string();
    TIFF* const file = TIFFOpen(path.c_str(), "w");
    TIFFSetField(file, TIFFTAG_IMAGEWIDTH, kTiffWidth);
    TIFFSetField(file, TIFFTAG_IMAGELENGTH, kTiffHeight);
    TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, kind.bits);
    TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, kind.samples);
    TIFFSetField(file, TIFFTAG_SAMPLEFORMAT, kind.format);
    TIFFSetField(file, TIFFTAG_COMPRESSION, kind.compression);
    TIFFSetField(file, TIFFTAG_PLANARCONFIG, kind.planes);
    TIFFSetField(file, TIFFTAG_PHOTOMETRIC, kind.samples < 3 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB);
    if (kind.samples % 2 == 0) {
        const std::uint16_t opacity = EXTRASAMPLE_UNASSALPHA;
        TIFFSetField(file, TIFFTAG_EXTRASAMPLES, 1, &opacity);
    }
    TIFFSetField(file, TIFFTAG_ROWSPERSTRIP, 5);
    for (std::uint32_t y = 0; y < kTiffHeight; ++y) {
        auto row = kind.format == SAMPLEFORMAT_IEEEFP ? tiffRow<float>(y, kind.samples, 1)
                   : kind.bits == 16                  ? tiffRow<std::uint16_t>(y, kind.samples, 65535)
                                                      : tiffRow<std::uint8_t>(y, kind.samples, 255);
        TIFFWriteScanline(file, row.data(), y);
    }
    TIFFClose(file);
    return test::bytesOfFile(path);
}

TEST(ImageTiffWebP, TiffOfEveryDepth) {
    for (const std::uint16_t compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE})
        for (const std::uint16_t bits : {8, 16, 32})
            for (const std::uint16_t samples : {1, 2, 3, 4}) {
                const std::uint16_t format = bits == 32 ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT;
                const std::string bytes = tiffFile({bits, samples, format, compression});
                const Texels texels = decodeTexels(std::as_bytes(std::span(bytes)), std::filesystem::path("a.tif"));
                ASSERT_EQ(texels.width, kTiffWidth);
                ASSERT_EQ(texels.height, kTiffHeight);
                for (std::uint32_t y = 0; y < kTiffHeight; ++y)
                    for (std::uint32_t x = 0; x < kTiffWidth; ++x) {
                        const std::size_t at = std::size_t{y} * kTiffWidth + x;
                        const bool hasAlpha = samples % 2 == 0 && bits < 32;
                        for (std::uint32_t c = 0; c < 3; ++c) {
                            const double expected = tiffValue(x, y, samples < 3 ? 0 : c);
                            const double found = bits == 8    ? texels.srgb8[3 * at + c] / 255.0
                                                 : bits == 16 ? texels.srgb16[3 * at + c] / 65535.0
                                                              : static_cast<double>(texels.linear[3 * at + c]);
                            ASSERT_NEAR(found, expected, bits == 8 ? 4e-3 : 2e-5) << bits << ' ' << samples;
                        }
                        if (!hasAlpha) continue;
                        const double alpha = bits == 8 ? texels.alpha8[at] / 255.0 : texels.alpha16[at] / 65535.0;
                        ASSERT_NEAR(alpha, tiffValue(x, y, samples - 1u), 4e-3);
                    }
            }
}

TEST(ImageTiffWebP, DamagedTiffIsRefused) {
    const std::string whole = tiffFile({.bits = 16, .compression = COMPRESSION_LZW});
    for (std::size_t size = 4; size < whole.size() / 2; size += 7) {
        const std::string error = textureErrorOf(whole.substr(0, size), "a.tif");
        EXPECT_EQ(error.find("a.tif: "), 0u) << size;
        EXPECT_EQ(error.find('\n'), std::string::npos);
    }
}

#endif

#ifdef RT_HAS_WEBP

TEST(ImageTiffWebP, WebPWithAndWithoutOpacity) {
    constexpr int kWidth = 21, kHeight = 13;
    std::vector<std::uint8_t> pixels(4 * kWidth * kHeight);
    for (const bool hasAlpha : {false, true}) {
        for (std::size_t i = 0; i < pixels.size(); ++i)
            pixels[i] =
                i % 4 == 3 ? static_cast<std::uint8_t>(hasAlpha ? 1 + i % 255 : 255) : static_cast<std::uint8_t>(i * 7);
        std::uint8_t* encoded = nullptr;
        const std::size_t size = WebPEncodeLosslessRGBA(pixels.data(), kWidth, kHeight, 4 * kWidth, &encoded);
        const std::string bytes(reinterpret_cast<const char*>(encoded), size);
        WebPFree(encoded);
        const Texels texels = decodeTexels(std::as_bytes(std::span(bytes)), std::filesystem::path("a.webp"));
        ASSERT_EQ(texels.width, 21u);
        ASSERT_EQ(texels.height, 13u);
        ASSERT_EQ(texels.alpha8.empty(), !hasAlpha);
        for (std::size_t i = 0; i < pixels.size() / 4; ++i) {
            for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(texels.srgb8[3 * i + c], pixels[4 * i + c]) << i;
            if (hasAlpha) {
                ASSERT_EQ(texels.alpha8[i], pixels[4 * i + 3]);
            }
        }
        for (std::size_t cut = 16; cut < bytes.size(); cut += 5)
            EXPECT_NE(textureErrorOf(bytes.substr(0, bytes.size() - cut), "a.webp"), "") << cut;
    }
}

#endif

} // namespace
} // namespace rt::image
