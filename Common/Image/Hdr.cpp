// Radiance HDR: text lines, an empty line, "-Y height +X width", then scanlines of RGBE pixels. Three mantissas m and
// an exponent e stand for (m + 1/2) 2^(e - 136), the middle of what is cut down to m when written: so does Radiance's
// own color.c (G. Ward, "Real Pixels", Graphics Gems II), and so does Blender. Whoever reads m 2^(e - 136), as stb and
// OpenImageIO do, gets files of any writer darker by half a step. A scanline is flat, or starts with (2, 2, width) and
// has its four components apart, each as runs: n > 128 repeats the next byte n - 128 times, 0 < n <= 128 copies n
// bytes. In flat scanlines of old files a pixel (1, 1, 1, n) repeats the one before it n times, and the next such pixel
// 256 n times. Written flat, in round figures: pixels of ours have a mantissa of 128 at least, so that no flat scanline
// looks like the other kinds. Our own, because stb 2.27 never returns from a file that ends within a run.
//
// Pixels are radiance times every EXPOSURE and COLORCORR of the header; PRIMARIES are chromaticities of red, green,
// blue and white, whose white stays white, as Radiance's own programs have it; FORMAT=32-bit_rle_xyze means XYZ in
// place of RGB, and PRIMARIES nothing.
#include <algorithm>
#include <array>
#include <cmath>
#include <istream>
#include <locale>
#include <optional>
#include <ostream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <glm/mat3x3.hpp>

#include "Common/Core/Error.h"
#include "Common/Core/Primaries.h"
#include "Common/Core/Printable.h"
#include "Common/Image/Codecs.h"
#include "Common/Image/ColorMatrix.h"

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
        if (text.ends_with('\r')) text.pop_back();
        return text;
    }
    [[noreturn]] void fail(const std::string& what) const { throw InputError(name_ + ": " + what); }

  private:
    std::span<const std::byte> bytes_;
    const std::string& name_;
    std::size_t at_ = 0;
};

// A direction in which scanlines, or pixels in them, follow each other.
struct HdrAxis {
    bool isX = false, isForward = true; // to the right, and down
    double length = 0;

    // In the image, of the i-th.
    std::uint32_t place(std::uint32_t i) const { return isForward ? i : static_cast<std::uint32_t>(length) - 1 - i; }
};

bool readAxis(std::istream& line, HdrAxis& axis) {
    std::string name;
    line >> name >> axis.length;
    axis.isX = name == "+X" || name == "-X";
    axis.isForward = name == "+X" || name == "-Y";
    return line && (axis.isX || name == "+Y" || name == "-Y");
}

struct HdrHeader {
    HdrAxis rows, columns;                     // as they are in the file: rows are scanlines, which may run up or down
    std::array<double, 3> factors = {1, 1, 1}; // that the radiance of each component was multiplied by
    std::optional<glm::dmat3> toRec709;        // unless the pixels are that
};

// The numbers of a line of the header; throws unless there are `count`, with nothing behind them.
std::vector<double> numbersOf(Bytes& in, const std::string& line, std::string_view key, std::size_t count) {
    std::istringstream text(line.substr(key.size()));
    text.imbue(std::locale::classic());
    std::vector<double> numbers;
    for (double number = 0; text >> number;) numbers.push_back(number);
    const bool areFinite = std::all_of(numbers.begin(), numbers.end(), [](double n) { return std::isfinite(n); });
    if (numbers.size() != count || !text.eof() || !areFinite)
        in.fail("HDR header: " + printable(line) + " (allowed: " + std::to_string(count) +
                (count == 1 ? " number)" : " numbers)"));
    return numbers;
}

void multiplyFactors(Bytes& in, const std::string& line, std::string_view key, std::size_t count, HdrHeader& header) {
    const std::vector<double> numbers = numbersOf(in, line, key, count);
    for (std::size_t c = 0; c < 3; ++c) {
        double& factor = header.factors[c];
        factor *= numbers[count == 1 ? 0 : c];
        if (!(factor > 0 && std::isfinite(factor) && std::isfinite(1 / factor)))
            in.fail("HDR header: " + printable(line) + " (allowed: > 0)");
    }
}

Primaries primariesOf(Bytes& in, const std::string& line, std::string_view key) {
    const std::vector<double> n = numbersOf(in, line, key, 8);
    return {{n[0], n[1]}, {n[2], n[3]}, {n[4], n[5]}, {n[6], n[7]}};
}

HdrHeader readHeader(Bytes& in) {
    if (const std::string magic = in.line(); magic != "#?RADIANCE" && magic != "#?RGBE") in.fail("not an HDR file");
    constexpr std::string_view kExposure = "EXPOSURE=", kCorrection = "COLORCORR=", kPrimaries = "PRIMARIES=";
    HdrHeader header;
    bool isXyz = false;
    for (std::string line = in.line(); !line.empty(); line = in.line()) {
        if (line == "FORMAT=32-bit_rle_xyze") {
            isXyz = true;
        } else if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe") {
            in.fail("HDR " + printable(line) + " is not supported (allowed: 32-bit_rle_rgbe, 32-bit_rle_xyze)");
        } else if (line.starts_with(kExposure)) {
            multiplyFactors(in, line, kExposure, 1, header);
        } else if (line.starts_with(kCorrection)) {
            multiplyFactors(in, line, kCorrection, 3, header);
        } else if (line.starts_with(kPrimaries)) {
            const Primaries primaries = primariesOf(in, line, kPrimaries);
            const std::optional<glm::dmat3> matrix = toRec709(primaries, White::Adapted);
            if (!matrix) in.fail("HDR header: " + printable(line) + ": primaries that span no colours");
            if (!areSame(primaries, kRec709)) header.toRec709 = matrix;
        }
    }
    if (isXyz) header.toRec709 = xyzToRec709();
    std::istringstream line(in.line());
    line.imbue(std::locale::classic());
    if (!readAxis(line, header.rows) || !readAxis(line, header.columns) || header.rows.isX == header.columns.isX)
        in.fail("HDR resolution is not of the form \"-Y height +X width\"");
    return header;
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

bool isRepetition(const Rgbe& pixel) {
    return pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1;
}

void readFlatRow(Bytes& in, const Rgbe& first, std::vector<Rgbe>& row) {
    if (isRepetition(first)) in.fail("damaged HDR file: a row begins with a repetition");
    row[0] = first;
    std::size_t factor = 1;
    for (std::size_t x = 1; x < row.size();) {
        const Rgbe pixel = in.nextPixel();
        if (!isRepetition(pixel)) {
            row[x++] = pixel;
            factor = 1;
            continue;
        }
        const std::size_t length = pixel[3] * factor;
        if (length > row.size() - x) in.fail("damaged HDR file: a run does not fit its row");
        std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(x), length, row[x - 1]);
        x += length;
        factor = std::min<std::size_t>(factor * 256, row.size() + 1);
    }
}

void readRow(Bytes& in, std::vector<Rgbe>& row) {
    const Rgbe first = in.nextPixel();
    const bool inRuns = first[0] == 2 && first[1] == 2 && std::size_t{first[2]} * 256 + first[3] == row.size();
    if (inRuns) {
        for (std::size_t component = 0; component < 4; ++component) readRuns(in, row, component);
    } else {
        readFlatRow(in, first, row);
    }
}

} // namespace

Image decodeHdr(std::span<const std::byte> bytes, const std::string& name) {
    Bytes in(bytes, name);
    const HdrHeader header = readHeader(in);
    const HdrAxis &rows = header.rows, &columns = header.columns;
    const HdrAxis &x = rows.isX ? rows : columns, &y = rows.isX ? columns : rows;
    checkDimensions(name, x.length, y.length, 4 * x.length * y.length, bytes.size());
    Image image(static_cast<std::uint32_t>(x.length), static_cast<std::uint32_t>(y.length));
    std::vector<Rgbe> row(rows.isX ? image.height : image.width);
    for (std::uint32_t i = 0; i < (rows.isX ? image.width : image.height); ++i) {
        readRow(in, row);
        const std::uint32_t across = rows.place(i);
        for (std::uint32_t k = 0; k < row.size(); ++k) {
            const std::uint32_t along = columns.place(k);
            expand(row[k], rows.isX ? image.pixel(across, along) : image.pixel(along, across));
        }
    }
    if (header.factors != std::array<double, 3>{1, 1, 1}) {
        for (std::size_t i = 0; i < image.data.size(); ++i)
            image.data[i] = static_cast<float>(double(image.data[i]) / header.factors[i % 3]);
    }
    if (header.toRec709) multiplyColors(image, *header.toRec709);
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
