// PNG, JPEG, BMP, TGA and HDR by the stb libraries, whose implementation is compiled here and nowhere else.
#include <algorithm>
#include <cmath>
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
#define STBI_ONLY_HDR
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

// The nearest colour with one shared exponent of 8 bits and three mantissas of 8 bits, which stb then stores as it is:
// left to itself it rounds mantissas down.
void roundToSharedExponent(float* pixel) {
    constexpr float kLargest = 1.69e38f;  // below 255 * 2^119, the largest mantissa at the largest exponent
    for (int c = 0; c < 3; ++c)
        pixel[c] = std::clamp(pixel[c], 0.0f, kLargest);
    const float largest = std::max({pixel[0], pixel[1], pixel[2]});
    if (largest < 1e-32f) {  // stb writes black
        std::fill_n(pixel, 3, 0.0f);
        return;
    }
    int exponent = 0;
    const float mantissa = std::frexp(largest, &exponent);  // [1/2, 1)
    if (mantissa * 256.0f >= 255.5f) ++exponent;            // it would round to 256
    for (int c = 0; c < 3; ++c)
        pixel[c] = std::ldexp(std::nearbyint(std::ldexp(pixel[c], 8 - exponent)), exponent - 8);
}

}  // namespace

Texels decodeStb(std::span<const std::byte> bytes, const std::string& name) {
    const auto fail = [&name](const std::string& what) { throw InputError(name + ": " + what); };
    if (bytes.size() > std::size_t(std::numeric_limits<int>::max())) fail("file is larger than 2 GiB");
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(bytes.size());
    const auto reason = [] { return std::string(stbi_failure_reason() ? stbi_failure_reason() : "unknown reason"); };

    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(data, size, &width, &height, &channels)) fail("cannot be read as an image: " + reason());
    checkDimensions(name, width, height, 3.0 * width * height, bytes.size());
    Texels texels{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}, {}};
    const auto values = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3;
    const auto decode = [&](auto load, auto& target) {
        using Value = std::remove_pointer_t<decltype(load(data, size, &width, &height, &channels, 3))>;
        const std::unique_ptr<Value, FreePixels> pixels(load(data, size, &width, &height, &channels, 3));
        if (!pixels) fail("damaged image: " + reason());
        target.assign(pixels.get(), pixels.get() + values);
    };
    if (stbi_is_hdr_from_memory(data, size))
        decode(stbi_loadf_from_memory, texels.linear);
    else
        decode(stbi_load_from_memory, texels.srgb8);
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

void encodeHdr(const Image& image, std::ostream& out) {
    std::vector<float> pixels(std::size_t{image.width} * image.height * 3);
    for (std::size_t i = 0; i < pixels.size(); ++i)
        pixels[i] = image.data[image.channels == 3 ? i : i / 3];
    for (std::size_t i = 0; i < pixels.size(); i += 3)
        roundToSharedExponent(&pixels[i]);
    const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
    if (!stbi_write_hdr_to_func(writeBytes, &out, width, height, 3, pixels.data())) throw std::bad_alloc();
}

bool inflate(std::span<const std::byte> in, std::span<std::byte> out) {
    constexpr std::size_t kLargest = std::numeric_limits<int>::max();
    if (in.size() > kLargest || out.size() > kLargest) return false;
    const int written = stbi_zlib_decode_buffer(reinterpret_cast<char*>(out.data()), static_cast<int>(out.size()),
                                                reinterpret_cast<const char*>(in.data()), static_cast<int>(in.size()));
    return written == static_cast<int>(out.size());
}

}  // namespace rt::image
