// Colours of files that state what they mean by them, against published matrices, and layers of EXR files.
#include <ImfChromaticitiesAttribute.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Core/Log.h"
#include "Common/Core/Primaries.h"
#include "Common/Image/Codecs.h"
#include "Common/Image/ColorMatrix.h"
#include "Common/Image/PngColor.h"
#include "tests/unit/ExrFiles.h"

namespace rt::image {
namespace {

const Imf::Chromaticities kXyzPrimaries({1, 0}, {0, 1}, {0, 0}, {1.0f / 3, 1.0f / 3});
const Imf::Chromaticities kDisplayP3({0.680f, 0.320f}, {0.265f, 0.690f}, {0.150f, 0.060f}, {0.3127f, 0.3290f});

Image colorPixel(float r, float g, float b) {
    Image image(1, 1);
    image.data = {r, g, b};
    return image;
}

std::string exrOf(const Image& image, const Imf::Chromaticities& primaries) {
    const test::ExrKind kind;
    Imf::Header header = test::exrHeader(image, kind);
    Imf::addChromaticities(header, primaries);
    const std::vector<char> planes = test::exrPlanes(image, kind.type);
    Imf::StdOSStream out;
    {
        Imf::OutputFile file(out, header, 0);
        file.setFrameBuffer(test::exrSlices(image, kind, planes));
        file.writePixels(static_cast<int>(image.height));
    }
    return out.str();
}

Image decodedExr(const std::string& bytes, const std::string& layer = {}) {
    return decodeExr(std::as_bytes(std::span(bytes)), "a.exr", layer);
}

void expectColor(const Image& image, const std::vector<float>& expected, float tolerance) {
    ASSERT_EQ(image.data.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(image.data[i], expected[i], tolerance) << i;
}

TEST(ImageColor, ExrPrimariesBecomeThoseOfRec709) {
    expectColor(decodedExr(exrOf(colorPixel(0.4124f, 0.2126f, 0.0193f), kXyzPrimaries)), {1, 0, 0}, 5e-4f);
    expectColor(decodedExr(exrOf(colorPixel(0.3576f, 0.7152f, 0.1192f), kXyzPrimaries)), {0, 1, 0}, 5e-4f);
    expectColor(decodedExr(exrOf(colorPixel(0.9505f, 1.0000f, 1.0890f), kXyzPrimaries)), {1, 1, 1}, 5e-4f);
    expectColor(decodedExr(exrOf(colorPixel(1, 0, 0), kDisplayP3)), {1.2249f, -0.0420f, -0.0197f}, 5e-4f);
    expectColor(decodedExr(exrOf(colorPixel(0, 1, 0), kDisplayP3)), {-0.2247f, 1.0419f, -0.0786f}, 5e-4f);
    expectColor(decodedExr(exrOf(colorPixel(3, 3, 3), kDisplayP3)), {3, 3, 3}, 1e-5f);
    const Image own = decodedExr(exrOf(colorPixel(0.1f, 0.2f, 0.3f), Imf::Chromaticities()));
    EXPECT_EQ(own.data, colorPixel(0.1f, 0.2f, 0.3f).data) << "stated, and the same";
}

TEST(ImageColor, ExrPrimariesThatSpanNothingAreAnError) {
    const float nan = std::nanf("");
    for (const Imf::Chromaticities& bad : {Imf::Chromaticities({0.3f, 0.3f}, {0.3f, 0.3f}, {0.3f, 0.3f}, {0.3f, 0.3f}),
                                           Imf::Chromaticities({0.6f, 0.3f}, {0.3f, 0.6f}, {0.1f, 0.1f}, {0.3f, 0}),
                                           Imf::Chromaticities({nan, 0.3f}, {0.3f, 0.6f}, {0.1f, 0.1f}, {0.3f, 0.3f})})
        try {
            decodedExr(exrOf(colorPixel(1, 1, 1), bad));
            ADD_FAILURE() << "no error";
        } catch (const InputError& e) {
            EXPECT_STREQ(e.what(), "a.exr: EXR attribute chromaticities: primaries that span no colours");
        }
}

// The format's library makes luminance and chroma of a quarter of the pixels from the colours.
TEST(ImageColor, ExrLuminanceAndChromaBecomeColours) {
    constexpr int kWidth = 64, kHeight = 48;
    for (const Imf::Chromaticities& primaries : {Imf::Chromaticities(), kDisplayP3}) {
        std::vector<Imf::Rgba> pixels;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                pixels.emplace_back(0.5f + 0.3f * std::sin(0.1f * x), 0.4f + 0.2f * std::cos(0.08f * y),
                                    0.6f + 0.2f * std::sin(0.05f * (x + y)));
        Imf::Header header(kWidth, kHeight);
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::addChromaticities(header, primaries);
        Imf::StdOSStream out;
        {
            Imf::RgbaOutputFile file(out, header, Imf::WRITE_YC);
            file.setFrameBuffer(pixels.data(), 1, kWidth);
            file.writePixels(kHeight);
        }
        const Image image = decodedExr(out.str());
        ASSERT_EQ(image.channels, 3u);
        Image expected(kWidth, kHeight);
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            expected.data[3 * i] = pixels[i].r;
            expected.data[3 * i + 1] = pixels[i].g;
            expected.data[3 * i + 2] = pixels[i].b;
        }
        const auto point = [](const Imath::V2f& v) { return glm::dvec2(v.x, v.y); };
        multiplyColors(expected, *toRec709({point(primaries.red), point(primaries.green), point(primaries.blue),
                                            point(primaries.white)},
                                           White::Kept));
        for (int y = 4; y < kHeight - 4; ++y) // the library's own filter has no neighbours at the border
            for (int x = 4; x < kWidth - 4; ++x)
                for (int c = 0; c < 3; ++c) {
                    const auto column = static_cast<std::uint32_t>(x), row = static_cast<std::uint32_t>(y);
                    ASSERT_NEAR(image.pixel(column, row)[c], expected.pixel(column, row)[c], 0.01f) << x << ' ' << y;
                }
    }
}

TEST(ImageColor, LayersOfExr) {
    Image image(1, 1, 8);
    for (std::size_t i = 0; i < 8; ++i) image.data[i] = float(i);
    const std::string bytes =
        test::exrFile(image, {.channels = {"R", "G", "B", "a.b.R", "a.b.G", "a.b.B", "depth.Z", "mask"}});
    const std::vector<std::string> layers = {"a.b", "depth"};
    EXPECT_EQ(findExrLayers(std::as_bytes(std::span(bytes)), "a.exr"), layers);
    EXPECT_EQ(decodedExr(bytes).data, (std::vector<float>{0, 1, 2}));
    EXPECT_EQ(decodedExr(bytes, "a.b").data, (std::vector<float>{3, 4, 5}));
    EXPECT_EQ(decodedExr(bytes, "depth").data, (std::vector<float>{6}));
    EXPECT_EQ(decodedExr(bytes, "depth.Z").data, (std::vector<float>{6}));
    EXPECT_EQ(decodedExr(bytes, "mask").data, (std::vector<float>{7}));
    try {
        decodedExr(bytes, "c\n");
        ADD_FAILURE() << "no error";
    } catch (const InputError& e) {
        EXPECT_STREQ(e.what(), "a.exr: EXR file has no layer \"c\\n\" that is a picture (it has: a.b, depth)");
    }
    const std::string without =
        test::exrFile(image, {.channels = {"Z", "depth.Z", "l.R", "l.G", "l.B", "m.R", "m.G", "m.B"}});
    EXPECT_EQ(decodedExr(without).data, (std::vector<float>{2, 3, 4})) << "the first that has colours";
    const Image first = colorPixel(1, 2, 3), second = colorPixel(4, 5, 6);
    EXPECT_EQ(decodedExr(test::exrFileOfParts({first, second}), "b").data, second.data) << "a part";
    EXPECT_THROW(decodeImage(std::as_bytes(std::span(bytes)), "a.hdr", "a"), InputError);
}

Image decodedHdr(const std::string& header, const std::string& pixels, int width = 1, int height = 1) {
    const std::string bytes =
        "#?RADIANCE\n" + header + "\n-Y " + std::to_string(height) + " +X " + std::to_string(width) + "\n" + pixels;
    return decodeHdr(std::as_bytes(std::span(bytes)), "a.hdr");
}

TEST(ImageColor, HdrHeaderTellsWhatPixelsMean) {
    const std::string grey = "\x80\x80\x80\x80"; // 0.502
    const float value = 128.5f / 256;
    expectColor(decodedHdr("EXPOSURE=2\nEXPOSURE= 0.25\n", grey), {2 * value, 2 * value, 2 * value}, 1e-6f);
    expectColor(decodedHdr("COLORCORR=1 2 4\n", grey), {value, value / 2, value / 4}, 1e-6f);
    expectColor(decodedHdr("PRIMARIES=0.640 0.330 0.290 0.600 0.150 0.060 0.333 0.333\n", grey), {value, value, value},
                1e-4f);
    expectColor(decodedHdr("PRIMARIES=.680 .320 .265 .690 .150 .060 .3127 .3290\n", std::string("\x80\0\0\x81", 4)),
                {1.2249f, -0.0420f, -0.0197f}, 0.012f);
    // X, Y and Z of white.
    expectColor(decodedHdr("FORMAT=32-bit_rle_xyze\n", "\x79\x7f\x8b\x81"), {1, 1, 1}, 0.01f);
    EXPECT_THROW(decodedHdr("EXPOSURE=0\n", grey), InputError);
    EXPECT_THROW(decodedHdr("EXPOSURE=nan\n", grey), InputError);
    EXPECT_THROW(decodedHdr("EXPOSURE=1 2\n", grey), InputError);
    EXPECT_THROW(decodedHdr("COLORCORR=1 2\n", grey), InputError);
    EXPECT_THROW(decodedHdr("PRIMARIES=0 0 0 0 0 0 0 0\n", grey), InputError);
}

TEST(ImageColor, HdrRunsOfOldFiles) {
    const std::string dark = "\x80\x80\x80\x80", bright = "\x90\x80\x80\x84";
    const Image image = decodedHdr("", dark + std::string("\1\1\1\2", 4) + bright + bright, 5);
    for (std::uint32_t x = 0; x < 5; ++x) EXPECT_EQ(image.pixel(x, 0)[0] > 1, x >= 3) << x;
    const Image wide = decodedHdr("", dark + std::string("\1\1\1\1\1\1\1\1", 8) + bright, 259);
    EXPECT_LT(wide.pixel(257, 0)[0], 1);
    EXPECT_GT(wide.pixel(258, 0)[0], 1);
    EXPECT_THROW(decodedHdr("", dark + std::string("\1\1\1\5", 4), 5), InputError);
    EXPECT_THROW(decodedHdr("", std::string("\1\1\1\5", 4) + dark, 5), InputError);
    EXPECT_THROW(decodedHdr("", dark + std::string("\1\1\1\0", 4), 5), InputError);
}

std::string pngChunk(const std::string& type, const std::string& data) {
    const auto size = static_cast<std::uint8_t>(data.size());
    return std::string({0, 0, 0, static_cast<char>(size)}) + type + data + "sum.";
}

std::string bigEndian(std::uint32_t value) {
    return {static_cast<char>(value >> 24), static_cast<char>(value >> 16 & 255), static_cast<char>(value >> 8 & 255),
            static_cast<char>(value & 255)};
}

// Lines end as on any system, and run as the resolution says.
TEST(ImageColor, HdrLinesRunAsTheHeaderSays) {
    const auto decode = [](const std::string& resolution) {
        std::string bytes = "#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n" + resolution + "\r\n";
        for (const char mantissa : {16, 32, 48, 64, 80, 96}) bytes += std::string(3, mantissa) + '\x88';
        const Image image = decodeHdr(std::as_bytes(std::span(bytes)), "a.hdr");
        std::vector<int> values;
        for (std::size_t i = 0; i < image.data.size(); i += 3) values.push_back(static_cast<int>(image.data[i]) / 16);
        return std::pair(image.width, values);
    };
    using Values = std::vector<int>;
    EXPECT_EQ(decode("-Y 2 +X 3"), std::pair(3u, Values{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(decode("+Y 2 +X 3"), std::pair(3u, Values{4, 5, 6, 1, 2, 3}));
    EXPECT_EQ(decode("-Y 2 -X 3"), std::pair(3u, Values{3, 2, 1, 6, 5, 4}));
    EXPECT_EQ(decode("+X 3 -Y 2"), std::pair(3u, Values{1, 3, 5, 2, 4, 6}));
    EXPECT_EQ(decode("-X 3 +Y 2"), std::pair(3u, Values{6, 4, 2, 5, 3, 1}));
    EXPECT_THROW(decode("-Y 2 +Y 3"), InputError);
    EXPECT_THROW(decode("-Z 2 +X 3"), InputError);
    EXPECT_THROW(decode("-Y 2 +X"), InputError);
}

TEST(ImageColor, PngThatIsNotSrgbSaysSo) {
    const auto colors = [](const std::string& chunks) {
        const std::string bytes =
            "\x89PNG\r\n\x1a\n" + pngChunk("IHDR", "0123456789abc") + chunks + pngChunk("IDAT", "");
        return otherColorsOfPng(std::as_bytes(std::span(bytes)));
    };
    const std::string usual = pngChunk("gAMA", bigEndian(45455)), linear = pngChunk("gAMA", bigEndian(100000));
    const auto primaries = [](std::uint32_t greenX) {
        std::string data;
        for (const std::uint32_t n : {31270u, 32900u, 64000u, 33000u, greenX, 60000u, 15000u, 6000u})
            data += bigEndian(n);
        return pngChunk("cHRM", data);
    };
    EXPECT_EQ(colors(""), std::nullopt);
    EXPECT_EQ(colors(usual + primaries(30000)), std::nullopt);
    EXPECT_EQ(colors(linear), "gamma 1 (gAMA)");
    EXPECT_EQ(colors(usual + primaries(21000)), "primaries of its own (cHRM)");
    EXPECT_EQ(colors(linear + primaries(21000)), "gamma 1 (gAMA) and primaries of its own (cHRM)");
    EXPECT_EQ(colors(linear + pngChunk("sRGB", "0")), std::nullopt);
    EXPECT_EQ(colors(pngChunk("iCCP", std::string("Display P3\0 0", 13))), "the colour profile \"Display P3\" (iCCP)");
    EXPECT_EQ(colors(linear + pngChunk("iCCP", std::string("sRGB IEC61966-2.1\0 0", 20))), std::nullopt);
    EXPECT_EQ(colors(linear + pngChunk("cICP", std::string("\1\15\0\1", 4))), std::nullopt);
    EXPECT_EQ(colors(pngChunk("sRGB", std::string(1, '\0')) + pngChunk("cICP", std::string("\11\20\0\1", 4))),
              "the colour space 9/16 of H.273 (cICP)");
    EXPECT_EQ(colors(std::string("\xff\xff\xff\xffgAMA")), std::nullopt) << "a chunk beyond the end";
}

} // namespace
} // namespace rt::image
