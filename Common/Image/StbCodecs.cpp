// PNG, JPEG, BMP and TGA, read by stb, whose implementation is compiled here and nowhere else.
#include <algorithm>
#include <limits>
#include <memory>

#include "Common/Core/Error.h"
#include "Common/Image/Codecs.h"
#include "Common/Image/Inflate.h"

#define STBI_NO_STDIO
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
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

bool isJpeg(std::span<const std::byte> bytes) {
    return bytes.size() >= 2 && bytes[0] == std::byte{0xff} && bytes[1] == std::byte{0xd8};
}

} // namespace

Texels decodeStb(std::span<const std::byte> bytes, const std::string& name) {
    const auto fail = [&name](const std::string& what) { throw InputError(name + ": " + what); };
    if (bytes.size() > std::size_t(std::numeric_limits<int>::max())) fail("file is larger than 2 GiB");
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(bytes.size());
    const auto reason = [] { return std::string(stbi_failure_reason() ? stbi_failure_reason() : "unknown reason"); };

    if (isJpeg(bytes)) checkJpeg(bytes, name);
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(data, size, &width, &height, &channels)) fail("cannot be read as an image: " + reason());
    checkDimensions(name, width, height, 3.0 * width * height, bytes.size());
    const std::unique_ptr<stbi_uc, FreePixels> pixels(
        stbi_load_from_memory(data, size, &width, &height, &channels, STBI_rgb));
    if (!pixels) fail("damaged image: " + reason());
    Texels texels{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}, {}};
    texels.srgb8.assign(pixels.get(), pixels.get() + std::size_t{texels.width} * texels.height * 3);
    return texels;
}

bool inflate(std::span<const std::byte> in, std::span<std::byte> out) {
    constexpr std::size_t kLargest = std::numeric_limits<int>::max();
    if (in.size() > kLargest || out.size() > kLargest) return false;
    const int written = stbi_zlib_decode_buffer(reinterpret_cast<char*>(out.data()), static_cast<int>(out.size()),
                                                reinterpret_cast<const char*>(in.data()), static_cast<int>(in.size()));
    return written == static_cast<int>(out.size());
}

} // namespace rt::image
