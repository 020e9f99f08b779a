// What an image file tells of its own making.
#include <cstddef>
#include <span>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "Common/Image/Codecs.h"
#include "Common/Image/ImageIo.h"
#include "Common/Image/PngText.h"
#include "tests/TempFolder.h"

namespace rt::image {
namespace {

const std::string kText = "{\"scene\": \"gr\xc3\xbc\xc3\x9f\", \"n\": 1}"; // UTF-8

std::span<const std::byte> bytesOf(const std::string& text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

TEST(ImageDescription, IsKeptBesideThePixels) {
    const test::TempFolder folder;
    Image image(5, 3);
    image.data[4] = 0.5f;
    for (const std::string name : {"a.png", "a.exr"}) {
        writeImage(folder / name, image);
        EXPECT_EQ(readDescription(folder / name), std::nullopt) << name;
        const Image plain = readImage(folder / name);
        writeImage(folder / name, image, kText);
        EXPECT_EQ(readDescription(folder / name), kText) << name;
        EXPECT_EQ(readImage(folder / name).data, plain.data) << name;
    }
    for (const std::string name : {"a.hdr", "a.pfm"}) {
        writeImage(folder / name, image, kText);
        EXPECT_EQ(readDescription(folder / name), std::nullopt) << name;
        EXPECT_EQ(readImage(folder / name).width, 5u) << name;
    }
}

TEST(ImageDescription, PngIsAsTheSpecificationSays) {
    std::ostringstream out;
    encodePng(Image(1, 1), out, "abc");
    const std::string png = out.str();
    // Length 19, type, key, five zeros, text; behind signature and header, before the first row.
    const std::size_t at = png.find(std::string("\0\0\0\x13iTXtray-tracing\0\0\0\0\0abc", 27));
    EXPECT_GE(at, 33u);
    EXPECT_LT(at, png.find("IDAT"));
    EXPECT_EQ(findPngText(bytesOf(png), kDescriptionKey), "abc");
    EXPECT_EQ(findPngText(bytesOf(png), "ray"), std::nullopt);
}

TEST(ImageDescription, OfADamagedPngIsNothing) {
    std::ostringstream png;
    encodePng(Image(2, 2), png, "text");
    const std::string whole = png.str();
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const auto found = findPngText(bytesOf(whole.substr(0, size)), kDescriptionKey);
        EXPECT_TRUE(!found || *found == "text") << size;
    }
    std::string endless = whole;
    for (int i = 33; i < 37; ++i) endless[static_cast<std::size_t>(i)] = '\xff'; // the chunk's length
    EXPECT_EQ(findPngText(bytesOf(endless), kDescriptionKey), std::nullopt);
    EXPECT_EQ(findPngText(bytesOf("no image"), kDescriptionKey), std::nullopt);
}

} // namespace
} // namespace rt::image
