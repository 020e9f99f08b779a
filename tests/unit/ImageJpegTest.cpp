// JPEG files made by libjpeg: grey, colour and inks; progressive files; what stands between bytes and pixels.
#include <algorithm>
#include <array>
#include <cstdio> // which jpeglib.h expects
#include <cstdlib>
#include <jpeglib.h>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Image/ImageIo.h"

namespace rt::image {
namespace {

constexpr std::uint32_t kWidth = 40, kHeight = 24;

struct Kind {
    J_COLOR_SPACE colors;
    std::vector<std::uint8_t> pixel; // of the whole image
    bool progressive = false;
    bool adobe = false;
};

std::string jpegFile(const Kind& kind) {
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* memory = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &memory, &size);
    jpeg.image_width = kWidth;
    jpeg.image_height = kHeight;
    jpeg.input_components = static_cast<int>(kind.pixel.size());
    jpeg.in_color_space = kind.colors;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 100, TRUE);
    jpeg.write_Adobe_marker = kind.adobe ? TRUE : FALSE;
    if (kind.progressive) jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    std::vector<std::uint8_t> row;
    for (std::uint32_t x = 0; x < kWidth; ++x) row.insert(row.end(), kind.pixel.begin(), kind.pixel.end());
    for (std::uint32_t y = 0; y < kHeight; ++y) {
        JSAMPROW rows[] = {row.data()};
        jpeg_write_scanlines(&jpeg, rows, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    std::string file(reinterpret_cast<char*>(memory), size);
    std::free(memory);
    return file;
}

Texels texelsOf(const std::string& file) {
    return decodeTexels(std::as_bytes(std::span(file)), std::string("a.jpg"));
}

std::string errorOfFile(const std::string& file) {
    try {
        texelsOf(file);
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

void expectAllPixels(const Kind& kind, const std::array<int, 3>& rgb) {
    const Texels texels = texelsOf(jpegFile(kind));
    ASSERT_EQ(texels.width, kWidth);
    ASSERT_EQ(texels.height, kHeight);
    ASSERT_EQ(texels.srgb8.size(), std::size_t{3} * kWidth * kHeight);
    for (std::size_t i = 0; i < texels.srgb8.size(); ++i) EXPECT_NEAR(texels.srgb8[i], rgb[i % 3], 2) << i;
}

TEST(ImageJpeg, GreyIsReadAsThreeEqualChannels) {
    expectAllPixels({JCS_GRAYSCALE, {77}}, {77, 77, 77});
}

TEST(ImageJpeg, BaselineAndProgressiveFilesHoldTheirColour) {
    expectAllPixels({JCS_RGB, {200, 90, 30}}, {200, 90, 30});
    expectAllPixels({JCS_RGB, {200, 90, 30}, true}, {200, 90, 30});
}

// 51 and 102 of 255 ink, 51 of black: 0.8 and 0.6 of the light come through, and 0.8 of that.
TEST(ImageJpeg, InksLetThroughWhatTheyDoNotTake) {
    expectAllPixels({JCS_CMYK, {51, 102, 0, 51}}, {163, 122, 204});
    expectAllPixels({JCS_CMYK, {204, 153, 255, 204}, false, true}, {163, 122, 204}); // stored as light
}

TEST(ImageJpeg, ScansWithoutEndAreRefused) {
    const std::string whole = jpegFile({JCS_RGB, {200, 90, 30}, true});
    const std::size_t last = whole.rfind("\xff\xda");
    ASSERT_NE(last, std::string::npos);
    const std::string begin = whole.substr(0, last), scan = whole.substr(last, whole.size() - 2 - last);
    std::string many = begin;
    for (int i = 0; i < 200; ++i) many += scan;
    EXPECT_EQ(errorOfFile(many + "\xff\xd9"), "a.jpg: cannot be read as a JPEG image: more than 100 scans");
    EXPECT_EQ(errorOfFile(begin + scan + scan + "\xff\xd9"), "");
}

TEST(ImageJpeg, TheHeaderTellsHowManyTexelsThereAre) {
    const std::string file = jpegFile({JCS_RGB, {1, 2, 3}});
    EXPECT_EQ(texelCount(std::as_bytes(std::span(file))), std::size_t{kWidth} * kHeight);
    EXPECT_EQ(texelCount(std::as_bytes(std::span(file)).first(30)), 0u);
}

} // namespace
} // namespace rt::image
