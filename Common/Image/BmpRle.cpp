// File layout ([MS-WMF] 2.2.2.3 and 2.1.1.7): a file header of 14 bytes, an info header of 40 or more, a palette of up
// to 256 colours (B, G, R, 0), then rows from the bottom in pairs of bytes, n and m:
//
//   n > 0      n pixels of m: of RLE8 its colour, of RLE4 the colours of its two halves in turn
//   0, 0       the row ends        0, 1   the picture ends
//   0, 2       two more bytes: so many pixels to the right and upwards, which keep the first colour
//   0, m > 2   m pixels as they are, filled up to a multiple of two bytes
#include "Common/Image/BmpRle.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "Common/Core/Error.h"
#include "Common/Image/Codecs.h"

namespace rt::image {

namespace {

constexpr std::size_t kInfoAt = 14, kMinInfo = 40;
constexpr std::uint32_t kRle8 = 1, kRle4 = 2;

std::uint32_t numberAt(std::span<const std::byte> bytes, std::size_t at, std::size_t size) {
    std::uint32_t value = 0;
    for (std::size_t i = size; i-- > 0;) value = value << 8 | std::to_integer<std::uint32_t>(bytes[at + i]);
    return value;
}

struct BmpHeader {
    double width, height;
    std::uint32_t compression, bits, colors;
    std::size_t paletteAt, pixelsAt;
};

BmpHeader headerOf(std::span<const std::byte> bytes) {
    BmpHeader h{};
    h.width = static_cast<std::int32_t>(numberAt(bytes, kInfoAt + 4, 4));
    h.height = static_cast<std::int32_t>(numberAt(bytes, kInfoAt + 8, 4));
    h.bits = numberAt(bytes, kInfoAt + 14, 2);
    h.compression = numberAt(bytes, kInfoAt + 16, 4);
    h.colors = numberAt(bytes, kInfoAt + 32, 4);
    h.paletteAt = kInfoAt + numberAt(bytes, kInfoAt, 4);
    h.pixelsAt = numberAt(bytes, 10, 4);
    return h;
}

class BmpDecoder {
  public:
    BmpDecoder(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    Texels decode() {
        const BmpHeader header = headerOf(bytes_);
        halves_ = header.compression == kRle4;
        if (header.bits != (halves_ ? 4u : 8u))
            fail("damaged BMP file: " + std::to_string(header.bits) + " bits a pixel in runs of " +
                 (halves_ ? "4" : "8"));
        checkDimensions(name_, header.width, header.height, 3 * header.width * header.height, bytes_.size());
        readPalette(header);
        width_ = static_cast<std::uint32_t>(header.width);
        height_ = static_cast<std::uint32_t>(header.height);
        indices_.resize(std::size_t{width_} * height_);
        at_ = header.pixelsAt;
        while (readStep()) continue;
        return texels();
    }

  private:
    using Color = std::array<std::uint8_t, 3>;

    void readPalette(const BmpHeader& header) {
        const std::uint32_t maximum = 1u << header.bits;
        const std::uint32_t colors = header.colors == 0 ? maximum : header.colors;
        if (colors > maximum || header.paletteAt > bytes_.size() || bytes_.size() - header.paletteAt < 4 * colors)
            fail("damaged BMP file: a palette of " + std::to_string(colors) + " colours (allowed: up to " +
                 std::to_string(maximum) + ", inside the file)");
        for (std::size_t i = 0; i < colors; ++i)
            for (std::size_t c = 0; c < 3; ++c)
                palette_[i][c] = std::to_integer<std::uint8_t>(bytes_[header.paletteAt + 4 * i + 2 - c]);
    }

    std::uint32_t next() {
        if (at_ >= bytes_.size()) fail("truncated BMP file");
        return std::to_integer<std::uint32_t>(bytes_[at_++]);
    }

    // Some programs fill rows to a multiple of four bytes, as they are where they are not compressed. Pixels beyond
    // that, or beyond the picture, are an error.
    void put(std::uint32_t index) {
        const std::uint32_t perWord = halves_ ? 8 : 4;
        const std::uint32_t filled = (width_ + perWord - 1) / perWord * perWord;
        if (x_ >= filled || y_ >= height_) fail("damaged BMP file: a run does not fit its row");
        if (x_ < width_) indices_[std::size_t{height_ - 1 - y_} * width_ + x_] = static_cast<std::uint8_t>(index);
        ++x_;
    }
    void putHalf(std::uint32_t byte, std::uint32_t i) { put(i % 2 == 0 ? byte >> 4 : byte & 15u); }

    void readPixels(std::uint32_t count) {
        const std::size_t first = at_;
        std::uint32_t byte = 0;
        for (std::uint32_t i = 0; i < count; ++i) {
            if (!halves_ || i % 2 == 0) byte = next();
            if (halves_)
                putHalf(byte, i);
            else
                put(byte);
        }
        if ((at_ - first) % 2 != 0) static_cast<void>(next());
    }

    // False: the picture ends.
    bool readStep() {
        const std::uint32_t count = next(), value = next();
        if (count > 0) {
            for (std::uint32_t i = 0; i < count; ++i) {
                if (halves_)
                    putHalf(value, i);
                else
                    put(value);
            }
            return true;
        }
        if (value == 0) {
            x_ = 0;
            return ++y_ < height_;
        }
        if (value == 2) {
            x_ += next();
            y_ += next();
        } else if (value > 2) {
            readPixels(value);
        }
        return value != 1;
    }

    Texels texels() const {
        Texels texels;
        texels.width = width_;
        texels.height = height_;
        texels.srgb8.reserve(3 * indices_.size());
        for (const std::uint8_t index : indices_)
            texels.srgb8.insert(texels.srgb8.end(), palette_[index].begin(), palette_[index].end());
        return texels;
    }

    [[noreturn]] void fail(const std::string& what) const { throw InputError(name_ + ": " + what); }

    std::span<const std::byte> bytes_;
    const std::string& name_;
    bool halves_ = false;
    std::uint32_t width_ = 0, height_ = 0, x_ = 0, y_ = 0; // y_: from the bottom
    std::array<Color, 256> palette_{};
    std::vector<std::uint8_t> indices_;
    std::size_t at_ = 0;
};

} // namespace

bool endsInBmpHeader(std::span<const std::byte> bytes) {
    if (bytes.size() < 2 || numberAt(bytes, 0, 2) != 0x4d42) return false;
    return bytes.size() < kInfoAt + 4 || bytes.size() - kInfoAt < numberAt(bytes, kInfoAt, 4);
}

bool isRunLengthBmp(std::span<const std::byte> bytes) {
    if (bytes.size() < kInfoAt + kMinInfo || numberAt(bytes, 0, 2) != 0x4d42) return false;
    const std::uint32_t compression = numberAt(bytes, kInfoAt + 16, 4);
    return numberAt(bytes, kInfoAt, 4) >= kMinInfo && (compression == kRle8 || compression == kRle4);
}

double runLengthBmpPixels(std::span<const std::byte> bytes) {
    const BmpHeader header = headerOf(bytes);
    return std::max(header.width, 0.0) * std::max(header.height, 0.0);
}

Texels decodeRunLengthBmp(std::span<const std::byte> bytes, const std::string& name) {
    return BmpDecoder(bytes, name).decode();
}

} // namespace rt::image
