// OpenEXR: single-part scanline images. Written uncompressed in 32-bit float; read with any channel type and
// compression none, RLE, ZIPS or ZIP. (File layout: openexr.com, "OpenEXR File Layout".)
//
//   magic, version | attributes: name type size value | table of block offsets | blocks: y, size, rows of the block;
//   in a row one channel after the other, in alphabetical order
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <ostream>

#include "Common/Core/Error.h"
#include "Common/Image/Codecs.h"
#include "Common/Image/Inflate.h"

namespace rt::image {

static_assert(std::endian::native == std::endian::little, "numbers are stored as they lie in memory");

namespace {

constexpr std::uint32_t kMagic = 20000630;
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kVersionMask = 0xff;
constexpr std::uint32_t kLongNames = 0x400; // the only flag of the version that we can read

enum PixelType : std::uint32_t { kUint, kHalf, kFloat };
enum Compression : std::uint8_t { kNone, kRle, kZips, kZip };

struct Box {
    std::int32_t minX, minY, maxX, maxY;
};

struct Channel {
    std::string name;
    std::uint32_t type = kFloat;
    std::size_t bytes() const { return type == kHalf ? 2 : 4; }
};

// ---- reading -------------------------------------------------------------------------------------------------------

// Reads numbers and strings in order, never beyond the end.
class Cursor {
  public:
    Cursor(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    std::span<const std::byte> take(std::size_t count) {
        if (bytes_.size() - at_ < count) fail("truncated EXR file");
        at_ += count;
        return bytes_.subspan(at_ - count, count);
    }
    template <class T>
    T number() {
        T value;
        std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
        return value;
    }
    std::string string() { // up to its terminating zero
        std::string text;
        while (const char c = number<char>()) text += c;
        return text;
    }
    void seek(std::uint64_t position) {
        if (position > bytes_.size()) fail("truncated EXR file");
        at_ = static_cast<std::size_t>(position);
    }
    const std::string& name() const { return name_; }
    [[noreturn]] void fail(const std::string& what) const { throw InputError(name_ + ": " + what); }

  private:
    std::span<const std::byte> bytes_;
    const std::string& name_;
    std::size_t at_ = 0;
};

struct Header {
    std::vector<Channel> channels;
    std::optional<Box> window;
    std::optional<std::uint8_t> compression;
    std::optional<std::string> description;

    std::size_t width() const { return static_cast<std::size_t>(std::int64_t{window->maxX} - window->minX + 1); }
    std::size_t height() const { return static_cast<std::size_t>(std::int64_t{window->maxY} - window->minY + 1); }
    std::size_t blockRows() const { return *compression == kZip ? 16 : 1; }
    std::size_t rowBytes() const {
        std::size_t pixel = 0;
        for (const Channel& channel : channels) pixel += channel.bytes();
        return pixel * width();
    }
};

std::vector<Channel> readChannels(Cursor& in) {
    std::vector<Channel> channels;
    for (std::string name = in.string(); !name.empty(); name = in.string()) {
        const auto type = in.number<std::uint32_t>();
        in.take(4); // perceptual linearity, reserved
        const auto samplingX = in.number<std::int32_t>(), samplingY = in.number<std::int32_t>();
        if (type > kFloat) in.fail("EXR channel " + name + " has unknown type " + std::to_string(type));
        if (samplingX != 1 || samplingY != 1) in.fail("EXR channel " + name + " is subsampled, which is not supported");
        channels.push_back({name, type});
    }
    return channels;
}

Header readHeader(Cursor& in) {
    if (in.number<std::uint32_t>() != kMagic) in.fail("not an EXR file");
    const auto version = in.number<std::uint32_t>();
    if ((version & kVersionMask) != kVersion || (version & ~(kVersionMask | kLongNames)) != 0)
        in.fail("tiled, deep and multi-part EXR files are not supported");
    Header header;
    for (std::string name = in.string(); !name.empty(); name = in.string()) {
        const std::string type = in.string();
        const auto size = in.number<std::uint32_t>();
        Cursor value(in.take(size), in.name());
        if (name == "channels") header.channels = readChannels(value);
        if (name == "compression") header.compression = value.number<std::uint8_t>();
        if (name == "dataWindow") header.window = value.number<Box>();
        if (name == kDescriptionKey && type == "string") {
            const auto text = value.take(size);
            header.description.emplace(reinterpret_cast<const char*>(text.data()), text.size());
        }
    }
    if (header.channels.empty() || !header.window || !header.compression)
        in.fail("EXR header lacks channels, compression or dataWindow");
    if (const std::size_t compression = *header.compression; compression > kZip) {
        constexpr const char* kOthers[] = {"PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB"};
        const std::size_t other = compression - kZip - 1;
        const std::string which = other < std::size(kOthers) ? kOthers[other] : std::to_string(compression);
        in.fail("EXR compression " + which + " is not supported (none, RLE, ZIPS, ZIP are)");
    }
    return header;
}

// RLE: a count n >= 0 repeats the next byte n + 1 times, n < 0 copies the next -n bytes. False when it does not fit.
bool expandRuns(std::span<const std::byte> in, std::span<std::byte> out) {
    std::size_t from = 0, to = 0;
    while (from + 1 < in.size()) {
        const int count = std::to_integer<signed char>(in[from++]);
        const auto length = static_cast<std::size_t>(count < 0 ? -count : count + 1);
        if (out.size() - to < length || (count < 0 && in.size() - from < length)) return false;
        if (count < 0)
            std::copy_n(in.begin() + from, length, out.begin() + to);
        else
            std::fill_n(out.begin() + to, length, in[from]);
        from += count < 0 ? length : 1;
        to += length;
    }
    return to == out.size();
}

// Undoes what RLE and ZIP do before compressing: bytes at even positions come first, and all but the first are
// differences.
void undoPrediction(std::vector<std::byte>& data) {
    for (std::size_t i = 1; i < data.size(); ++i)
        data[i] =
            static_cast<std::byte>(std::to_integer<unsigned>(data[i - 1]) + std::to_integer<unsigned>(data[i]) - 128);
    std::vector<std::byte> woven(data.size());
    const std::size_t half = (data.size() + 1) / 2;
    for (std::size_t i = 0; i < data.size(); ++i) woven[i] = data[i % 2 == 0 ? i / 2 : half + i / 2];
    data.swap(woven);
}

std::vector<std::byte> decodeBlock(Cursor& in, std::uint8_t compression, std::size_t size) {
    const auto stored = in.take(in.number<std::uint32_t>());
    if (stored.size() == size) return {stored.begin(), stored.end()}; // what would not shrink is stored as it is
    std::vector<std::byte> data(size);
    const bool whole = compression == kRle ? expandRuns(stored, data) : compression != kNone && inflate(stored, data);
    if (!whole) in.fail("damaged EXR block");
    undoPrediction(data);
    return data;
}

float halfToFloat(std::uint16_t half) {
    const int exponent = half >> 10 & 31;
    const int mantissa = half & 1023;
    const float sign = half >> 15 ? -1.0f : 1.0f;
    if (exponent == 31) return mantissa == 0 ? sign * INFINITY : NAN;
    return sign *
           (exponent == 0 ? std::ldexp(float(mantissa), -24) : std::ldexp(float(mantissa + 1024), exponent - 25));
}

float readValue(const std::byte* from, std::uint32_t type) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, from, type == kHalf ? 2 : 4);
    if (type == kHalf) return halfToFloat(static_cast<std::uint16_t>(bits));
    return type == kFloat ? std::bit_cast<float>(bits) : static_cast<float>(bits);
}

// For each channel of the file the channel of the image that it fills, or nothing: R, G, B, or else Y alone.
std::vector<std::optional<std::size_t>> chooseChannels(const Header& header, const Cursor& in, std::uint32_t& count) {
    const auto has = [&header](const char* name) {
        return std::any_of(header.channels.begin(), header.channels.end(), [=](auto& c) { return c.name == name; });
    };
    const bool colour = has("R") && has("G") && has("B");
    if (!colour && !has("Y")) in.fail("EXR file has neither channels R, G, B nor Y");
    const std::string names = colour ? "RGB" : "Y";
    std::vector<std::optional<std::size_t>> targets;
    for (const Channel& channel : header.channels) {
        const std::size_t found = channel.name.size() == 1 ? names.find(channel.name) : std::string::npos;
        targets.push_back(found == std::string::npos ? std::nullopt : std::optional(found));
    }
    count = static_cast<std::uint32_t>(names.size());
    return targets;
}

// Writes the values of a block, whose first row is `row` of the image, to where they belong.
void storeBlock(const std::vector<std::byte>& data, const Header& header,
                const std::vector<std::optional<std::size_t>>& targets, std::uint32_t row, Image& image) {
    for (const std::byte* from = data.data(); from != data.data() + data.size(); ++row) {
        for (std::size_t c = 0; c < header.channels.size(); ++c) {
            const Channel& channel = header.channels[c];
            for (std::uint32_t x = 0; x < image.width; ++x, from += channel.bytes())
                if (targets[c]) image.pixel(x, row)[*targets[c]] = readValue(from, channel.type);
        }
    }
}

} // namespace

Image decodeExr(std::span<const std::byte> bytes, const std::string& name) {
    Cursor in(bytes, name);
    const Header header = readHeader(in);
    const double width = 1.0 + header.window->maxX - header.window->minX;
    const double height = 1.0 + header.window->maxY - header.window->minY;
    checkDimensions(name, width, height, width * height * 2.0 * double(header.channels.size()), bytes.size());

    std::uint32_t channelCount = 0;
    const auto targets = chooseChannels(header, in, channelCount);
    Image image(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), channelCount);
    const std::size_t blocks = (header.height() + header.blockRows() - 1) / header.blockRows();
    Cursor table(in.take(blocks * sizeof(std::uint64_t)), name);
    for (std::size_t block = 0; block < blocks; ++block) {
        in.seek(table.number<std::uint64_t>());
        const std::int64_t first = std::int64_t{in.number<std::int32_t>()} - header.window->minY;
        if (first < 0 || first >= std::int64_t{image.height} || first % std::int64_t(header.blockRows()) != 0)
            in.fail("damaged EXR block");
        const std::size_t rows = std::min(header.blockRows(), image.height - static_cast<std::size_t>(first));
        const auto data = decodeBlock(in, *header.compression, rows * header.rowBytes());
        storeBlock(data, header, targets, static_cast<std::uint32_t>(first), image);
    }
    return image;
}

std::optional<std::string> findExrText(std::span<const std::byte> bytes, const std::string& name) {
    Cursor in(bytes, name);
    return readHeader(in).description;
}

// ---- writing -------------------------------------------------------------------------------------------------------

namespace {

template <class T>
void append(std::string& text, const T& value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void appendAttribute(std::string& text, const char* name, const char* type, const std::string& value) {
    text.append(name).push_back('\0');
    text.append(type).push_back('\0');
    append(text, static_cast<std::uint32_t>(value.size()));
    text += value;
}

template <class... T>
std::string packed(const T&... values) {
    std::string text;
    (append(text, values), ...);
    return text;
}

std::string makeHeader(const ImageRows& image, const std::string& channels, const std::string& description) {
    std::string list;
    for (const char channel : channels)
        list += packed(channel, '\0', std::uint32_t{kFloat}, std::uint32_t{0}, std::int32_t{1}, std::int32_t{1});
    list.push_back('\0');
    const std::string window =
        packed(Box{0, 0, static_cast<std::int32_t>(image.width - 1), static_cast<std::int32_t>(image.height - 1)});

    std::string header = packed(kMagic, kVersion);
    appendAttribute(header, "channels", "chlist", list);
    appendAttribute(header, "compression", "compression", packed(std::uint8_t{kNone}));
    appendAttribute(header, "dataWindow", "box2i", window);
    appendAttribute(header, "displayWindow", "box2i", window);
    appendAttribute(header, "lineOrder", "lineOrder", packed(std::uint8_t{0})); // increasing y
    appendAttribute(header, "pixelAspectRatio", "float", packed(1.0f));
    appendAttribute(header, "screenWindowCenter", "v2f", packed(0.0f, 0.0f));
    appendAttribute(header, "screenWindowWidth", "float", packed(1.0f));
    if (!description.empty()) appendAttribute(header, kDescriptionKey, "string", description);
    header.push_back('\0');
    return header;
}

} // namespace

void encodeExr(const ImageRows& image, std::ostream& out, const std::string& description) {
    const std::string channels = image.channels == 3 ? "BGR" : "Y";
    const std::string header = makeHeader(image, channels, description);
    const std::uint32_t rowBytes = image.width * image.channels * sizeof(float);
    const std::uint64_t blockBytes = 2 * sizeof(std::uint32_t) + rowBytes;
    const std::uint64_t firstBlock = header.size() + std::uint64_t{image.height} * sizeof(std::uint64_t);

    out << header;
    std::string offsets;
    for (std::uint32_t y = 0; y < image.height; ++y) append(offsets, firstBlock + y * blockBytes);
    out << offsets;
    std::vector<float> row(image.rowValues());
    for (std::uint32_t y = 0; y < image.height; ++y) {
        image.read(y, row);
        std::string block = packed(y, rowBytes);
        for (std::uint32_t c = image.channels; c-- > 0;) // B, G, R: the image's channels backwards
            for (std::uint32_t x = 0; x < image.width; ++x) append(block, row[std::size_t{x} * image.channels + c]);
        out << block;
    }
}

} // namespace rt::image
