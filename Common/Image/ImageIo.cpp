#include "Common/Image/ImageIo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>
#include <utility>

#include "Common/Core/AtomicFile.h"
#include "Common/Core/Error.h"
#include "Common/Core/Printable.h"
#include "Common/Core/ReadFile.h"
#include "Common/Core/TextSearch.h"
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

constexpr Format kFormats[] = {{".png", Codec::Png},       {".exr", Codec::Exr},      {".hdr", Codec::Hdr},
                               {".pfm", Codec::Pfm},       {".jpg", Codec::ReadOnly}, {".jpeg", Codec::ReadOnly},
                               {".bmp", Codec::ReadOnly},  {".tga", Codec::ReadOnly}, {".tif", Codec::ReadOnly},
                               {".tiff", Codec::ReadOnly}, {".webp", Codec::ReadOnly}};

// Formats of textures that other programs read.
const char* knownElsewhere(const std::string& extension) {
    constexpr std::pair<const char*, const char*> kOthers[] = {{".dds", "DDS"}, {".ktx", "KTX"}, {".ktx2", "KTX2"},
                                                               {".gif", "GIF"}, {".psd", "PSD"}, {".avif", "AVIF"}};
    for (const auto& [known, name] : kOthers)
        if (extension == known) return name;
    return nullptr;
}

// The codec of the name's extension; throws `Unknown`, with those that are allowed, when there is none.
template <class Unknown>
Codec codecOf(const fs::path& path, bool writing) {
    const std::string extension = lowerCase(path.extension().string());
    std::string allowed;
    for (const Format& format : kFormats) {
        if (writing && format.codec == Codec::ReadOnly) continue;
        if (extension == format.extension) return format.codec;
        allowed += std::string(allowed.empty() ? "" : ", ") + format.extension;
    }
    if (const char* const other = knownElsewhere(extension))
        throw Unknown(path.string() + ": " + other + " files are not supported (allowed: " + allowed + ")");
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
    std::copy(texels.linear.begin(), texels.linear.end(), image.data.begin());
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

// Of linear formats: what textures may be.
void checkLinear(Texels& texels, const std::string& name) {
    const auto isFinite = [](float value) { return std::isfinite(value); };
    if (!std::all_of(texels.linear.begin(), texels.linear.end(), isFinite))
        throw InputError(name + ": texels that are not finite");
    for (float& value : texels.linear) value = std::max(value, 0.0f);
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

// PNG, JPEG, BMP, TGA, TIFF or WebP, as the bytes say, whatever the file is called.
Texels decodeSrgb(std::span<const std::byte> bytes, const std::string& name) {
    if (bytes.size() > kMaxSrgbBytes) throw InputError(name + ": file is larger than 2 GiB");
    if (isJpeg(bytes)) return decodeJpeg(bytes, name);
    if (isTiff(bytes)) return decodeTiff(bytes, name);
    return isWebP(bytes) ? decodeWebP(bytes, name) : decodeStb(bytes, name);
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

Image decodeImage(std::span<const std::byte> bytes, const fs::path& path, const std::string& layer) {
    const Codec codec = codecOf<InputError>(path, false);
    if (!layer.empty() && codec != Codec::Exr)
        throw InputError(path.string() + ": layer \"" + printable(layer) + "\": only .exr files have layers");
    switch (codec) {
        case Codec::Exr:
            return decodeExr(bytes, path.string(), layer);
        case Codec::Pfm:
            return decodePfm(bytes, path.string());
        case Codec::Hdr:
            return decodeHdr(bytes, path.string());
        default:
            return toLinear(decodeSrgb(bytes, path.string()));
    }
}

Image readImage(const fs::path& path, const std::string& layer) {
    codecOf<InputError>(path, false); // before reading what cannot be decoded
    return decodeImage(readFile(path, kMaxFileBytes), path, layer);
}

std::vector<std::string> readLayers(const fs::path& path) {
    if (codecOf<InputError>(path, false) != Codec::Exr) return {};
    return findExrLayers(readFile(path, kMaxFileBytes), path.string());
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
    const bool isEncoded = codec == Codec::Png || codec == Codec::ReadOnly;
    Texels texels = isEncoded ? decodeSrgb(bytes, path.string()) : toTexels(decodeImage(bytes, path));
    checkLinear(texels, path.string());
    return texels;
}

Texels decodeTexels(std::span<const std::byte> bytes, const std::string& name) {
    Texels texels = decodeSrgb(bytes, name);
    checkLinear(texels, name);
    return texels;
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
