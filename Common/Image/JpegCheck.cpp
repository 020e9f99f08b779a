// What stb 2.27 does not notice in a damaged JPEG file: it fills what is missing with grey, and writes beyond its
// tables when a Huffman table claims more than 256 codes. (Syntax: ITU-T T.81, annex B.)

#include "Common/Core/Error.h"
#include "Common/Image/Codecs.h"

namespace rt::image {

namespace {

constexpr unsigned kHuffmanTables = 0xc4;
constexpr unsigned kEndOfImage = 0xd9;

unsigned at(std::span<const std::byte> bytes, std::size_t index) {
    return std::to_integer<unsigned>(bytes[index]);
}

// TEM, RSTn, SOI, and the zero that follows 0xff in compressed data.
bool standsAlone(unsigned marker) {
    return marker <= 1 || (marker >= 0xd0 && marker <= 0xd8);
}

// Each table: class, 16 numbers of codes by length, as many symbols.
bool hasGoodTables(std::span<const std::byte> segment) {
    constexpr std::size_t kHead = 17;
    while (!segment.empty()) {
        if (segment.size() < kHead) return false;
        std::size_t codes = 0;
        for (std::size_t i = 1; i < kHead; ++i) codes += at(segment, i);
        if (codes > 256 || segment.size() < kHead + codes) return false;
        segment = segment.subspan(kHead + codes);
    }
    return true;
}

} // namespace

void checkJpeg(std::span<const std::byte> bytes, const std::string& name) {
    for (std::size_t i = 0; i + 1 < bytes.size();) {
        const unsigned marker = at(bytes, i + 1);
        if (at(bytes, i) != 0xff || marker == 0xff) { // compressed data, or padding before a marker
            ++i;
            continue;
        }
        i += 2;
        if (marker == kEndOfImage) return;
        if (standsAlone(marker)) continue;
        if (bytes.size() - i < 2) break;
        const std::size_t length = at(bytes, i) << 8 | at(bytes, i + 1); // counts itself
        if (length < 2 || bytes.size() - i < length) break;
        if (marker == kHuffmanTables && !hasGoodTables(bytes.subspan(i + 2, length - 2)))
            throw InputError(name + ": damaged JPEG file");
        i += length;
    }
    throw InputError(name + ": truncated JPEG file");
}

} // namespace rt::image
