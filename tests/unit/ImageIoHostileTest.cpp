// Truncated, damaged and lying files end in an InputError that names the file: no crash, no hang, no huge allocation.
#include <algorithm>
#include <fstream>
#include <iterator>
#include <random>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Image/Codecs.h"
#include "tests/TempFolder.h"
#include "tests/unit/ExrFiles.h"

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

std::string dataOf(const std::string& name) {
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
    for (const std::string name : {"rle-half.exr", "zip-half.exr", "piz-half.exr", "gradient.hdr", "gradient.jpg"})
        files.push_back({name, dataOf(name)});
    for (const auto& [name, compression] :
         {std::pair{"pxr24.exr", Imf::PXR24_COMPRESSION}, std::pair{"b44.exr", Imf::B44_COMPRESSION},
          std::pair{"dwaa.exr", Imf::DWAA_COMPRESSION}, std::pair{"dwab.exr", Imf::DWAB_COMPRESSION}})
        files.push_back({name, test::exrFile(image, {.type = Imf::HALF, .compression = compression})});
    files.push_back({"tiles.exr", test::exrFile(image, {.levels = Imf::ONE_LEVEL})});
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

// Fill bytes may precede any marker, that of the file's begin, too.
TEST(ImageIoHostile, AJpegWithTooManyCodesIsRefusedHoweverItBegins) {
    const std::string whole = dataOf("gradient.jpg");
    const std::size_t table = whole.find("\xff\xc4");
    ASSERT_NE(table, std::string::npos);
    std::string damaged = whole;
    damaged[table + 5] = damaged[table + 6] = '\xff'; // of 1 and of 2 bits, after marker, length and class
    for (const std::size_t fill : {0, 1, 3}) {
        const std::string begin(fill, '\xff');
        EXPECT_EQ(errorOf("a.jpg", begin + whole), "") << fill;
        EXPECT_EQ(errorOf("a.jpg", begin + damaged),
                  "a.jpg: cannot be read as a JPEG image: Bogus Huffman table definition")
            << fill;
    }
}

TEST(ImageIoHostile, SidesThatAreNoNumbersOfPixelsAreShownAsTheyAre) {
    EXPECT_NE(errorOf("a.pfm", "PF\n5e87 1.5\n-1\n").find("a.pfm: image of 5e+87x1.5 pixels"), std::string::npos);
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
    EXPECT_NE(errorOf("deep.exr", test::deepExrFile()).find("type \"deepscanline\" are not supported"),
              std::string::npos);
    EXPECT_NE(errorOf("lab.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_lab\n\n-Y 1 +X 1\n1234").find("32-bit_rle_xyze"),
              std::string::npos);
    EXPECT_NE(errorOf("twice.hdr", "#?RADIANCE\n\n+X 1 -X 1\n1234").find("-Y height +X width"), std::string::npos);
    EXPECT_NE(errorOf("text.png", "this is text"), "");
}

// Of the bytes behind `key`, those from `offset` on replaced.
std::string patched(std::string bytes, const std::string& key, std::size_t offset, const std::string& by) {
    const std::size_t at = bytes.find(key);
    EXPECT_NE(at, std::string::npos) << key;
    return at == std::string::npos ? bytes : bytes.replace(at + key.size() + offset, by.size(), by);
}

TEST(ImageIoHostile, ExrHeadersAreNotBelieved) {
    const auto expectError = [](const std::string& bytes, const std::string& what) {
        EXPECT_NE(errorOf("a.exr", bytes).find(what), std::string::npos) << errorOf("a.exr", bytes) << " / " << what;
    };
    const std::string plain = test::exrFile(Image(9, 1), {.compression = Imf::DWAB_COMPRESSION});
    const std::string tiles = test::exrFile(Image(9, 1), {.levels = Imf::ONE_LEVEL});
    const std::string huge("\xff\xff\xff\x7f", 4), none(4, '\0'), large("\x60\xea\0\0", 4); // 60000
    constexpr std::size_t kSize = 4;                                                        // of an attribute

    expectError("v/1\2" + plain.substr(4), "not an EXR file");
    expectError(std::string(plain).replace(4, 1, "\3"), "version 3");
    expectError(patched(plain, std::string("compression\0compression\0", 24), kSize, "\x4d"), "compression");
    const std::string window("dataWindow\0box2i\0", 17), aspect("pixelAspectRatio\0float\0", 23);
    expectError(patched(plain, window, 0, huge), "truncated");
    expectError(patched(plain, aspect, 0, none), "attribute \"pixelAspectRatio\" of type float has 0 bytes");
    expectError(patched(plain, std::string("channels\0chlist\0", 16), 0, std::string("\x24\0\0\0", 4)), "truncated");
    expectError(patched(plain, window, kSize + 8, large), "chunks of more than 67108864 bytes in a file of ");
    expectError(patched(plain, window, kSize + 12, large), "truncated");
    expectError(patched(plain, window, kSize + 8, huge), "window"); // whose width overflows
    const std::string tileSize("tiles\0tiledesc\0", 15);
    expectError(patched(tiles, tileSize, kSize, std::string("\0\0\0\4", 4)), "chunks of more than 67108864 bytes");
    expectError(patched(tiles, tileSize, kSize, huge + huge), "chunks of more than 67108864 bytes");
    expectError(patched(tiles, tileSize, kSize, none), "tile size");
    expectError(patched(plain, std::string("R\0\2\0\0\0", 6), 4, std::string("\3\0\0\0", 4)),
                "EXR channel R is subsampled");
    expectError(plain.substr(0, 8) + std::string("a\0idmanifest\0\x08\0\0\0", 17) + plain.substr(8), "ID manifest");
}

// Errors with texts of the file are one printable line.
TEST(ImageIoHostile, TextsInExrFilesAreMadePrintable) {
    const std::string error =
        errorOf("a.exr", test::exrFile(Image(1, 1), {.channels = {"x\x1b[2J", "\n", std::string(250, 'y')}}));
    EXPECT_NE(error.find("(it has: \\n, x\\x1b[2J, yy"), std::string::npos) << error;
    EXPECT_LT(error.size(), 400u);
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
