// Radiance HDR: text lines, an empty line, "-Y height +X width", then scanlines of RGBE pixels. Three mantissas m and
// an exponent e stand for (m + 1/2) 2^(e - 136), the middle of what is cut down to m when written: so does Radiance's
// own color.c (G. Ward, "Real Pixels", Graphics Gems II), and so does Blender. Whoever reads m 2^(e - 136), as stb and
// OpenImageIO do, gets files of any writer darker by half a step. A scanline is flat, or starts with (2, 2, width) and
// has its four components apart, each as runs: n > 128 repeats the next byte n - 128 times, 0 < n <= 128 copies n
// bytes. Written flat, in round figures: pixels of ours have a mantissa of 128 at least, so that no flat scanline looks
// like the other kind. Our own, because stb 2.27 never returns from a file that ends within a run. The header's
// EXPOSURE is ignored.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <ostream>
#include <sstream>

#include "Common/Core/Error.h"
#include "Common/Image/Codecs.h"

namespace rt::image {

namespace {

using Rgbe = std::array<std::uint8_t, 4>;

void expand(const Rgbe& rgbe, float* pixel) {
    for (std::size_t c = 0; c < 3; ++c)
        pixel[c] = rgbe[3] == 0 ? 0.0f : std::ldexp(float(rgbe[c]) + 0.5f, rgbe[3] - 136);
}

// Mantissas for the exponent of the largest component.
Rgbe compress(const float* pixel) {
    constexpr float kLargest = 0x1.fffffep126f; // just below 256 2^(255 - 136)
    constexpr float kMin = 0x1p-128f; // 128 2^(1 - 136) is the least with a full mantissa; what is less is black
    std::array<float, 3> color;
    for (std::size_t c = 0; c < 3; ++c) color[c] = std::clamp(pixel[c], 0.0f, kLargest);
    const float largest = std::max({color[0], color[1], color[2]});
    if (largest < kMin) return {};
    int exponent = 0;
    static_cast<void>(std::frexp(largest, &exponent)); // the fraction is in [1/2, 1)
    Rgbe rgbe;
    for (std::size_t c = 0; c < 3; ++c) rgbe[c] = static_cast<std::uint8_t>(std::ldexp(color[c], 8 - exponent));
    rgbe[3] = static_cast<std::uint8_t>(exponent + 128);
    return rgbe;
}

// The bytes after the header. Going beyond the end is an error.
class Bytes {
  public:
    Bytes(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}
    std::uint8_t next() {
        if (at_ == bytes_.size()) fail("truncated HDR file");
        return std::to_integer<std::uint8_t>(bytes_[at_++]);
    }
    Rgbe nextPixel() {
        Rgbe rgbe;
        std::generate(rgbe.begin(), rgbe.end(), [this] { return next(); });
        return rgbe;
    }
    std::string line() {
        std::string text;
        for (char c = 0; (c = static_cast<char>(next())) != '\n';) text += c;
        return text;
    }
    [[noreturn]] void fail(const std::string& what) const { throw InputError(name_ + ": " + what); }

  private:
    std::span<const std::byte> bytes_;
    const std::string& name_;
    std::size_t at_ = 0;
};

struct Size {
    double width = 0, height = 0;
};

Size readHeader(Bytes& in) {
    if (const std::string magic = in.line(); magic != "#?RADIANCE" && magic != "#?RGBE") in.fail("not an HDR file");
    for (std::string line = in.line(); !line.empty(); line = in.line())
        if (line.rfind("FORMAT=", 0) == 0 && line != "FORMAT=32-bit_rle_rgbe")
            in.fail("HDR " + line + " is not supported (FORMAT=32-bit_rle_rgbe is)");
    std::istringstream line(in.line());
    std::string y, x;
    Size size;
    if (!(line >> y >> size.height >> x >> size.width) || y != "-Y" || x != "+X")
        in.fail("HDR resolution is not of the form \"-Y height +X width\"");
    return size;
}

// One component of all pixels of a scanline.
void readRuns(Bytes& in, std::vector<Rgbe>& row, std::size_t component) {
    for (std::size_t x = 0; x < row.size();) {
        const std::size_t count = in.next();
        const std::size_t length = count > 128 ? count - 128 : count;
        if (length == 0 || length > row.size() - x) in.fail("damaged HDR file: a run does not fit its row");
        const std::uint8_t repeated = count > 128 ? in.next() : 0;
        for (const std::size_t end = x + length; x < end; ++x) row[x][component] = count > 128 ? repeated : in.next();
    }
}

void readRow(Bytes& in, std::vector<Rgbe>& row) {
    const Rgbe first = in.nextPixel();
    const bool inRuns = first[0] == 2 && first[1] == 2 && std::size_t{first[2]} * 256 + first[3] == row.size();
    if (inRuns) {
        for (std::size_t component = 0; component < 4; ++component) readRuns(in, row, component);
    } else {
        row[0] = first;
        std::generate(row.begin() + 1, row.end(), [&in] { return in.nextPixel(); });
    }
}

} // namespace

Image decodeHdr(std::span<const std::byte> bytes, const std::string& name) {
    Bytes in(bytes, name);
    const auto [width, height] = readHeader(in);
    checkDimensions(name, width, height, 4 * width * height, bytes.size());
    Image image(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height));
    std::vector<Rgbe> row(image.width);
    for (std::uint32_t y = 0; y < image.height; ++y) {
        readRow(in, row);
        for (std::uint32_t x = 0; x < image.width; ++x) expand(row[x], image.pixel(x, y));
    }
    return image;
}

void encodeHdr(const ImageRows& rows, std::ostream& out) {
    out << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " << rows.height << " +X " << rows.width << '\n';
    std::vector<float> row(rows.rowValues());
    for (std::uint32_t y = 0; y < rows.height; ++y) {
        rows.read(y, row);
        for (std::size_t i = 0; i < row.size(); i += rows.channels) {
            const float grey[3] = {row[i], row[i], row[i]};
            const Rgbe rgbe = compress(rows.channels == 3 ? &row[i] : grey);
            out.write(reinterpret_cast<const char*>(rgbe.data()), rgbe.size());
        }
    }
}

} // namespace rt::image
