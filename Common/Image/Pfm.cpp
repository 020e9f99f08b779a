// Portable float map: "PF" (RGB) or "Pf" (grey), width, height, a scale whose sign tells the byte order (negative:
// little endian) and whose magnitude is ignored, one white space, then rows of floats from the bottom up.
#include <algorithm>
#include <bit>
#include <cstring>
#include <sstream>

#include "Common/Core/Error.h"
#include "Common/Image/Codecs.h"

namespace rt::image {

static_assert(std::endian::native == std::endian::little, "rows are written as they lie in memory");

namespace {

void swapBytes(float& value) {
    std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
    bits = bits >> 24 | (bits >> 8 & 0xff00u) | (bits << 8 & 0xff0000u) | bits << 24;
    std::memcpy(&value, &bits, sizeof value); // not through a float register, which might quiet a NaN
}

} // namespace

Image decodePfm(std::span<const std::byte> bytes, const std::string& name) {
    constexpr std::size_t kLongestHeader = 128;
    std::istringstream header(
        std::string(reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), kLongestHeader)));
    std::string magic;
    double width = 0, height = 0, scale = 0;
    header >> magic >> width >> height >> scale;
    if ((magic != "PF" && magic != "Pf") || !header || header.get() < 0 || scale == 0)
        throw InputError(name + ": not a PFM file (\"PF\" or \"Pf\", width, height, scale)");
    const std::uint32_t channels = magic == "PF" ? 3 : 1;
    const auto start = static_cast<std::size_t>(header.tellg());
    checkDimensions(name, width, height, width * height * channels * sizeof(float), bytes.size());

    const auto rowValues = static_cast<std::size_t>(width) * channels;
    const std::size_t rowBytes = rowValues * sizeof(float);
    if ((bytes.size() - start) / rowBytes < static_cast<std::size_t>(height))
        throw InputError(name + ": truncated PFM file");
    Image image(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), channels);
    for (std::size_t row = 0; row < image.height; ++row)
        std::memcpy(&image.data[(image.height - 1 - row) * rowValues], &bytes[start + row * rowBytes], rowBytes);
    if (scale > 0) std::for_each(image.data.begin(), image.data.end(), swapBytes);
    return image;
}

void encodePfm(const ImageRows& rows, std::ostream& out) {
    out << (rows.channels == 3 ? "PF\n" : "Pf\n") << rows.width << ' ' << rows.height << "\n-1.0\n";
    std::vector<float> row(rows.rowValues());
    for (std::uint32_t y = rows.height; y-- > 0;) {
        rows.read(y, row);
        out.write(reinterpret_cast<const char*>(row.data()), static_cast<std::streamsize>(row.size() * sizeof(float)));
    }
}

} // namespace rt::image
