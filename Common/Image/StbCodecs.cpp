// PNG, JPEG, BMP and TGA by the stb libraries, whose implementation is compiled here and nowhere else.
#include <algorithm>
#include <limits>
#include <memory>
#include <ostream>

#include "Common/Core/Error.h"
#include "Common/Image/Codecs.h"
#include "Common/Image/Inflate.h"
#include "Common/Shared/Tonemap.h"

#define STBI_NO_STDIO
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_LINEAR
#define STB_IMAGE_STATIC
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb_image.h>
#include <stb_image_write.h>

namespace rt::image {

namespace {

struct FreePixels {
    void operator()(void* pixels) const { stbi_image_free(pixels); }
};

void writeBytes(void* context, void* data, int size) {
    static_cast<std::ostream*>(context)->write(static_cast<const char*>(data), size);
}

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

void encodePng(const Image& image, std::ostream& out) {
    std::vector<std::uint8_t> bytes(image.data.size());
    std::transform(image.data.begin(), image.data.end(), bytes.begin(), [](float linear) {
        const float encoded = shared::srgbEncode(std::clamp(linear, 0.0f, 1.0f));
        return static_cast<std::uint8_t>(encoded * 255.0f + 0.5f);
    });
    const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
    const int channels = static_cast<int>(image.channels);
    if (!stbi_write_png_to_func(writeBytes, &out, width, height, channels, bytes.data(), width * channels))
        throw std::bad_alloc();
}

bool inflate(std::span<const std::byte> in, std::span<std::byte> out) {
    constexpr std::size_t kLargest = std::numeric_limits<int>::max();
    if (in.size() > kLargest || out.size() > kLargest) return false;
    const int written = stbi_zlib_decode_buffer(reinterpret_cast<char*>(out.data()), static_cast<int>(out.size()),
                                                reinterpret_cast<const char*>(in.data()), static_cast<int>(in.size()));
    return written == static_cast<int>(out.size());
}

} // namespace rt::image
