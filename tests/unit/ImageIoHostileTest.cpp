// Truncated, damaged and lying files end in an InputError that names the file: no crash, no hang, no huge allocation.
#include <algorithm>
#include <fstream>
#include <iterator>
#include <random>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Image/Codecs.h"
#include "tests/TempFolder.h"

namespace rt::image {
namespace {

struct File {
    std::string name;
    std::string content;
};

std::string contentOf(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string dataFile(const std::string& name) {
    return contentOf(std::filesystem::path(RT_TEST_DATA_DIR) / "images" / name);
}

// A small good file of each format that is read.
std::vector<File> makeFiles() {
    Image image(9, 5);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = float(i % 17) / 17;
    const test::TempFolder folder;
    std::vector<File> files;
    for (const std::string name : {"a.png", "a.exr", "a.hdr", "a.pfm"}) {
        writeImage(folder / name, image);
        files.push_back({name, contentOf(folder / name)});
    }
    for (const std::string name : {"rle-half.exr", "zip-half.exr", "gradient.hdr", "gradient.jpg"})
        files.push_back({name, dataFile(name)});
    return files;
}

// The first bytes of a PNG of that size.
std::string pngHeader(std::uint32_t width, std::uint32_t height) {
    std::string bytes("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR", 16);
    for (const std::uint32_t number : {width, height})
        for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift);
    return bytes + std::string("\x08\x02\0\0\0", 5);
}

// The error of reading the bytes as a file of that name; empty when there is none.
std::string errorOf(const std::string& name, const std::string& bytes) {
    try {
        decodeImage(std::as_bytes(std::span(bytes)), name);
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

TEST(ImageIoHostile, APngThatIsTooLargeSaysSo) {
    EXPECT_NE(errorOf("a.png", pngHeader(30000, 30000)).find("a.png: image of 30000x30000 pixels"), std::string::npos);
}

TEST(ImageIoHostile, TruncationIsNoticedAtEveryByte) {
    for (const auto& [name, whole] : makeFiles()) {
        // A PNG file is complete without the checksum of its end marker.
        const std::size_t spare = name == "a.png" ? 4 : 0;
        for (std::size_t size = 0; size + spare < whole.size(); ++size)
            ASSERT_NE(errorOf(name, whole.substr(0, size)).find(name), std::string::npos) << name << " at " << size;
        EXPECT_EQ(errorOf(name, whole), "") << name;
    }
}

TEST(ImageIoHostile, DamageIsAnErrorOrAnImage) {
    std::mt19937 random(11);
    for (const auto& [name, whole] : makeFiles()) {
        std::size_t noticed = 0;
        for (int trial = 0; trial < 2000; ++trial) {
            std::string damaged = whole;
            for (unsigned changes = 1 + random() % 4; changes > 0; --changes)
                damaged[random() % std::min<std::size_t>(damaged.size(), 400)] =
                    static_cast<char>(random() % 2 ? random() : 0xff);
            noticed += errorOf(name, damaged).empty() ? 0 : 1;
        }
        EXPECT_GT(noticed, 20u) << name;
    }
}

TEST(ImageIoHostile, ClaimsBeyondTheFileAreNotBelieved) {
    EXPECT_NE(errorOf("a.pfm", "PF\n60000 60000\n-1.0\n1234567890").find("60000x60000"), std::string::npos);
    EXPECT_NE(errorOf("a.pfm", "PF\n100000 1\n-1.0\n1234567890").find("allowed"), std::string::npos);
    EXPECT_NE(errorOf("a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 60000\n1234").find("60000x60000"),
              std::string::npos);
    for (const std::string size : {"0 5", "-3 5", "5 -3", "2.5 1", "nan 1", "1e9 1", "99999999999999999999 1", "x y"})
        EXPECT_NE(errorOf("a.pfm", "PF\n" + size + "\n-1.0\n123456789012345678901234567890"), "") << size;
}

TEST(ImageIoHostile, SaysWhatIsNotSupported) {
    EXPECT_NE(errorOf("piz.exr", dataFile("piz-half.exr")).find("compression PIZ is not"), std::string::npos);
    std::string tiled = dataFile("none-float.exr");
    tiled[5] = 2;
    EXPECT_NE(errorOf("tiled.exr", tiled).find("tiled"), std::string::npos);
    EXPECT_NE(errorOf("xyz.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n1234").find("xyze"),
              std::string::npos);
    EXPECT_NE(errorOf("turned.hdr", "#?RADIANCE\n\n+X 1 -Y 1\n1234").find("-Y height +X width"), std::string::npos);
    EXPECT_NE(errorOf("text.png", "this is text"), "");
}

TEST(ImageIoHostile, MissingFilesAndFolders) {
    const test::TempFolder folder;
    EXPECT_THROW(readImage(folder / "none.exr"), InputError);
    EXPECT_THROW(loadTexels(folder / "none.png"), InputError);
    std::filesystem::create_directory(folder / "folder.exr");
    EXPECT_THROW(readImage(folder / "folder.exr"), InputError);
}

} // namespace
} // namespace rt::image
