// WebP, read by libwebp where it was there when this was built: pictures, not animations.
#include <string>

#include "Common/Core/Error.h"
#include "Common/Image/Codecs.h"

#ifdef RT_HAS_WEBP
#include <algorithm>
#include <cstdint>
#include <vector>
#include <webp/decode.h>
#endif

namespace rt::image {

bool isWebP(std::span<const std::byte> bytes) {
    if (bytes.size() < 12) return false;
    const std::string begin(reinterpret_cast<const char*>(bytes.data()), 12);
    return begin.starts_with("RIFF") && begin.ends_with("WEBP");
}

#ifndef RT_HAS_WEBP

Texels decodeWebP(std::span<const std::byte>, const std::string& name) {
    throw InputError(name + ": WebP files are not supported by this build, which had no libwebp");
}

#else

Texels decodeWebP(std::span<const std::byte> bytes, const std::string& name) {
    constexpr double kUsualPixels = 64.0 * 1024 * 1024; // bytes that any file may ask for: one colour takes hardly any
    const auto fail = [&name](const char* what) { throw InputError(name + ": " + what); };
    const auto* const data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    WebPBitstreamFeatures features{};
    const VP8StatusCode status = WebPGetFeatures(data, bytes.size(), &features);
    if (status == VP8_STATUS_NOT_ENOUGH_DATA) fail("truncated WebP file");
    if (status != VP8_STATUS_OK) fail("damaged WebP file");
    if (features.has_animation != 0) fail("animated WebP files are not supported");
    const std::size_t channels = features.has_alpha != 0 ? 4 : 3;
    const double size = double(channels) * features.width * features.height;
    checkDimensions(name, features.width, features.height, std::max(size - kUsualPixels, 0.0), bytes.size());
    Texels texels;
    texels.width = static_cast<std::uint32_t>(features.width);
    texels.height = static_cast<std::uint32_t>(features.height);
    const std::size_t count = std::size_t{texels.width} * texels.height, stride = channels * texels.width;
    std::vector<std::uint8_t> pixels(channels * count);
    const auto* const decoded = (channels == 4 ? WebPDecodeRGBAInto : WebPDecodeRGBInto)(
        data, bytes.size(), pixels.data(), pixels.size(), static_cast<int>(stride));
    if (decoded == nullptr) fail("damaged or truncated WebP file");
    if (channels == 3) {
        texels.srgb8 = std::move(pixels);
        return texels;
    }
    texels.srgb8.reserve(3 * count);
    texels.alpha8.reserve(count);
    for (std::size_t i = 0; i < pixels.size(); i += 4) {
        texels.srgb8.insert(texels.srgb8.end(), {pixels[i], pixels[i + 1], pixels[i + 2]});
        texels.alpha8.push_back(pixels[i + 3]);
    }
    return texels;
}

#endif

} // namespace rt::image
