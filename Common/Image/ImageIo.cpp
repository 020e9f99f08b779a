#include "Common/Image/ImageIo.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iomanip>
#include <limits>
#include <new>
#include <sstream>

#include "Common/Core/AtomicFile.h"
#include "Common/Core/Error.h"
#include "Common/Core/ReadFile.h"
#include "Common/Image/Codecs.h"
#include "Common/Image/PngText.h"
#include "Common/Shared/Tonemap.h"

namespace rt::image {

namespace fs = std::filesystem;

namespace {

constexpr double kMaxSide = 65536;
constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 33;

enum class Codec { Exr, Pfm, Hdr, Png, ReadOnly };

struct Format {
    const char* extension;
    Codec codec;
};

constexpr Format kFormats[] = {{".png", Codec::Png},      {".exr", Codec::Exr},      {".hdr", Codec::Hdr},
                               {".pfm", Codec::Pfm},      {".jpg", Codec::ReadOnly}, {".jpeg", Codec::ReadOnly},
                               {".bmp", Codec::ReadOnly}, {".tga", Codec::ReadOnly}};

// The codec of the name's extension; throws `Unknown`, with those that are allowed, when there is none.
template <class Unknown>
Codec codecOf(const fs::path& path, bool writing) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    std::string allowed;
    for (const Format& format : kFormats) {
        if (writing && format.codec == Codec::ReadOnly) continue;
        if (extension == format.extension) return format.codec;
        allowed += std::string(allowed.empty() ? "" : ", ") + format.extension;
    }
    throw Unknown(path.string() + ": unknown image format \"" + extension + "\" (allowed: " + allowed + ")");
}

std::array<float, 256> makeDecodingTable() {
    std::array<float, 256> table;
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = shared::srgbDecode(static_cast<float>(i) / 255.0f);
    return table;
}

Image toLinear(const Texels& texels) {
    static const std::array<float, 256> table = makeDecodingTable();
    Image image(texels.width, texels.height);
    std::transform(texels.srgb8.begin(), texels.srgb8.end(), image.data.begin(),
                   [](std::uint8_t b) { return table[b]; });
    std::transform(texels.srgb16.begin(), texels.srgb16.end(), image.data.begin(),
                   [](std::uint16_t v) { return shared::srgbDecode(float(v) / 65535.0f); });
    return image;
}

Texels toTexels(const Image& image) {
    Texels texels;
    texels.width = image.width;
    texels.height = image.height;
    texels.linear.resize(std::size_t{image.width} * image.height * 3);
    for (std::size_t i = 0; i < texels.linear.size(); ++i)
        texels.linear[i] = image.data[image.channels == 3 ? i : i / 3];
    return texels;
}

bool isFinite(const Image& image) {
    return std::all_of(image.data.begin(), image.data.end(), [](float value) { return std::isfinite(value); });
}

float finite(float value) {
    constexpr float kLargest = std::numeric_limits<float>::max();
    return std::isnan(value) ? 0.0f : std::clamp(value, -kLargest, kLargest);
}

void encode(Codec codec, const ImageRows& rows, std::ostream& out, const std::string& description) {
    switch (codec) {
        case Codec::Exr:
            return encodeExr(rows, out, description);
        case Codec::Pfm:
            return encodePfm(rows, out);
        case Codec::Hdr:
            return encodeHdr(rows, out);
        default:
            return encodePng(rows, out, description);
    }
}

// Which the decoders of sRGB count in integers.
constexpr std::size_t kMaxSrgbBytes = std::numeric_limits<int>::max();

// PNG, JPEG, BMP or TGA, as the bytes say, whatever the file is called.
Texels decodeSrgb(std::span<const std::byte> bytes, const std::string& name) {
    if (bytes.size() > kMaxSrgbBytes) throw InputError(name + ": file is larger than 2 GiB");
    return isJpeg(bytes) ? decodeJpeg(bytes, name) : decodeStb(bytes, name);
}

} // namespace

void checkDimensions(const std::string& name, double width, double height, double decodedBytes, std::size_t fileBytes) {
    const auto text = [](double side) { // a header may claim any number
        constexpr int kDigits = 10;
        std::ostringstream out;
        out << std::setprecision(kDigits) << side;
        return out.str();
    };
    const auto good = [](double side) { return side >= 1 && side <= kMaxSide && side == std::floor(side); };
    if (!good(width) || !good(height))
        throw InputError(name + ": image of " + text(width) + "x" + text(height) + " pixels (allowed: 1 to " +
                         text(kMaxSide) + " on each side)");
    if (decodedBytes > kDensest * double(fileBytes))
        throw InputError(name + ": truncated image: " + text(width) + "x" + text(height) + " pixels do not fit into " +
                         std::to_string(fileBytes) + " bytes");
}

Image decodeImage(std::span<const std::byte> bytes, const fs::path& path) {
    switch (codecOf<InputError>(path, false)) {
        case Codec::Exr:
            return decodeExr(bytes, path.string());
        case Codec::Pfm:
            return decodePfm(bytes, path.string());
        case Codec::Hdr:
            return decodeHdr(bytes, path.string());
        default:
            return toLinear(decodeSrgb(bytes, path.string()));
    }
}

Image readImage(const fs::path& path) {
    codecOf<InputError>(path, false); // before reading what cannot be decoded
    return decodeImage(readFile(path, kMaxFileBytes), path);
}

Texels loadTexels(const fs::path& path) {
    return decodeTexels(readTexels(path), path);
}

std::vector<std::byte> readTexels(const fs::path& path) {
    codecOf<InputError>(path, false); // before reading what cannot be decoded
    return readFile(path, kMaxFileBytes);
}

Texels decodeTexels(std::span<const std::byte> bytes, const fs::path& path) {
    const Codec codec = codecOf<InputError>(path, false);
    if (codec == Codec::Png || codec == Codec::ReadOnly) return decodeSrgb(bytes, path.string());
    const Image image = decodeImage(bytes, path);
    if (!isFinite(image)) throw InputError(path.string() + ": texels that are not finite");
    Texels texels = toTexels(image);
    for (float& value : texels.linear) value = std::max(value, 0.0f);
    return texels;
}

Texels decodeTexels(std::span<const std::byte> bytes, const std::string& name) {
    return decodeSrgb(bytes, name);
}

std::size_t texelCount(std::span<const std::byte> bytes) {
    if (bytes.size() > kMaxSrgbBytes) return 0;
    const double pixels = isJpeg(bytes) ? jpegPixels(bytes) : stbPixels(bytes);
    return static_cast<std::size_t>(std::clamp(pixels, 0.0, kDensest * double(bytes.size())));
}

void writeImage(const fs::path& path, const ImageRows& image, const std::string& description) try {
    const Codec codec = codecOf<UsageError>(path, true);
    AtomicFile file(path);
    encode(codec, mapped(image, finite), file.stream(), description);
    file.commit();
} catch (const Error&) {
    throw;
} catch (const std::exception& error) { // of a library, or want of memory
    throw RenderError("cannot write " + path.string() + ": " + messageOf(error));
}

std::optional<std::string> findDescription(std::span<const std::byte> bytes, const fs::path& path) {
    const bool isPng = codecOf<InputError>(path, false) == Codec::Png;
    return isPng ? findPngText(bytes, kDescriptionKey) : findExrText(bytes, path.string());
}

std::optional<std::string> readDescription(const fs::path& path) {
    const Codec codec = codecOf<InputError>(path, false);
    if (codec != Codec::Png && codec != Codec::Exr) return std::nullopt;
    return findDescription(readFile(path, kMaxFileBytes), path);
}

void checkWritable(const fs::path& path) {
    codecOf<UsageError>(path, true);
}

bool isDisplayReferred(const fs::path& path) {
    return codecOf<UsageError>(path, true) == Codec::Png;
}

} // namespace rt::image
