// PNG, BMP and TGA, read by stb, whose implementation is compiled here and nowhere else.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include "Common/Core/Error.h"
#include "Common/Core/Log.h"
#include "Common/Image/BmpRle.h"
#include "Common/Image/Codecs.h"
#include "Common/Image/PngColor.h"

#define STBI_NO_STDIO
#define STBI_ONLY_PNG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_LINEAR
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#include <stb_image.h>

namespace rt::image {

namespace {

struct FreePixels {
    void operator()(void* pixels) const { stbi_image_free(pixels); }
};

// stb takes a PNG that is too large for it for no image at all.
void checkPng(std::span<const std::byte> bytes, const std::string& name) {
    constexpr std::size_t kSignatureBytes = 8, kWidthAt = 16, kHeightAt = 20;
    constexpr double kMaxValues = 1 << 30;
    if (bytes.size() < kHeightAt + 4 || std::memcmp(bytes.data(), "\x89PNG\r\n\x1a\n", kSignatureBytes) != 0) return;
    const auto number = [bytes](std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t i = at; i < at + 4; ++i) value = value << 8 | std::to_integer<std::uint32_t>(bytes[i]);
        return value;
    };
    const std::uint32_t width = number(kWidthAt), height = number(kHeightAt);
    if (3.0 * width * height > kMaxValues)
        throw InputError(name + ": image of " + std::to_string(width) + "x" + std::to_string(height) +
                         " pixels: a .png may have at most 2^30 values of red, green and blue");
    // stb takes memory for what a chunk states before it looks for the bytes.
    for (std::size_t at = kSignatureBytes; at + kSignatureBytes <= bytes.size();) {
        const std::size_t length = number(at), left = bytes.size() - at - kSignatureBytes;
        if (length > left && std::memcmp(&bytes[at + 4], "IDAT", 4) == 0)
            throw InputError(name + ": damaged image: a chunk of " + std::to_string(length) +
                             " bytes, of which there are " + std::to_string(left));
        at += std::min(length, left) + kSignatureBytes + 4; // its sum as well
    }
}

// Pixels of four channels, or of three without opacity, as colours and opacities.
template <typename T>
void split(const T* pixels, std::size_t count, bool hasAlpha, std::vector<T>& colors, std::vector<T>& alphas) {
    if (!hasAlpha) {
        colors.assign(pixels, pixels + 3 * count);
        return;
    }
    colors.reserve(3 * count);
    alphas.reserve(count);
    for (const T* pixel = pixels; pixel != pixels + 4 * count; pixel += 4) {
        colors.insert(colors.end(), pixel, pixel + 3);
        alphas.push_back(pixel[3]);
    }
}

} // namespace

double stbPixels(std::span<const std::byte> bytes) {
    if (isRunLengthBmp(bytes)) return runLengthBmpPixels(bytes);
    int width = 0, height = 0, channels = 0;
    const bool known = stbi_info_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()),
                                             static_cast<int>(bytes.size()), &width, &height, &channels) != 0;
    return known ? double(width) * std::abs(double(height)) : 0;
}

Texels decodeStb(std::span<const std::byte> bytes, const std::string& name) {
    const auto fail = [&name](const std::string& what) { throw InputError(name + ": " + what); };
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(bytes.size());
    const auto reason = [] { return std::string(stbi_failure_reason() ? stbi_failure_reason() : "unknown reason"); };

    if (endsInBmpHeader(bytes)) fail("truncated BMP file");
    if (isRunLengthBmp(bytes)) return decodeRunLengthBmp(bytes, name);
    checkPng(bytes, name);
    if (const auto colors = otherColorsOfPng(bytes))
        logWarning(name + ": " + *colors + " is left out: colours are read as sRGB");
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(data, size, &width, &height, &channels)) fail("cannot be read as an image: " + reason());
    // stb turns the rows of a BMP that begins with the upper one, and states its height as the file does.
    if (std::memcmp(data, "BM", 2) == 0 && height < 0) height = height == std::numeric_limits<int>::min() ? 0 : -height;
    const bool hasAlpha = channels == STBI_grey_alpha || channels == STBI_rgb_alpha;
    const std::size_t stride = hasAlpha ? 4 : 3;
    checkDimensions(name, width, height, double(stride) * width * height, bytes.size());
    Texels texels;
    texels.width = static_cast<std::uint32_t>(width);
    texels.height = static_cast<std::uint32_t>(height);
    const std::size_t count = std::size_t{texels.width} * texels.height;
    if (stbi_is_16_bit_from_memory(data, size)) {
        const std::unique_ptr<stbi_us, FreePixels> wide(
            stbi_load_16_from_memory(data, size, &width, &height, &channels, static_cast<int>(stride)));
        if (!wide) fail("damaged image: " + reason());
        split(wide.get(), count, hasAlpha, texels.srgb16, texels.alpha16);
        return texels;
    }
    const std::unique_ptr<stbi_uc, FreePixels> pixels(
        stbi_load_from_memory(data, size, &width, &height, &channels, static_cast<int>(stride)));
    if (!pixels) fail("damaged image: " + reason());
    split(pixels.get(), count, hasAlpha, texels.srgb8, texels.alpha8);
    return texels;
}

} // namespace rt::image
