#include "Common/Scene/Gltf/GltfImagePacking.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "Common/Shared/Base/Types.h"
#include "Common/Shared/Texture/Color.h"

namespace rt::scene {

namespace {

// IEC 61966-2-1.
double encode(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

// A channel of a texel as materials see it, where opacity is never encoded.
double valueAt(const TexelData& data, std::size_t texel, Channel channel, ColorSpace space) {
    const auto c = static_cast<std::size_t>(channel);
    const bool isOpacity = channel == Channel::Alpha;
    double value = 1;
    bool isEncoded = true;
    if (data.format == shared::kTexelSrgb8) {
        value = (data.words[texel] >> 8 * c & 255u) / 255.0;
    } else {
        const std::size_t width = data.format == shared::kTexelLinearF32A ? 4 : 3;
        if (c < width) value = double(shared::uintBitsToFloat(data.words[width * texel + c]));
        isEncoded = data.isEncoded;
    }
    return isEncoded && !isOpacity && space == ColorSpace::Srgb ? double(shared::srgbToLinear(float(value))) : value;
}

} // namespace

PackedImage packImage(const GltfChannels& channels, ColorSpace space,
                      const std::function<const TexelData&(const ImageTexture&)>& texelsOf) {
    PackedImage packed;
    packed.channels = channels[3] ? 4 : 3;
    for (const auto& channel : channels) {
        if (!channel || channel->image == nullptr) continue;
        packed.width = std::max(packed.width, texelsOf(*channel->image).width);
        packed.height = std::max(packed.height, texelsOf(*channel->image).height);
    }
    packed.texels.assign(std::size_t{packed.width} * packed.height * packed.channels, 255);
    for (std::uint32_t c = 0; c < packed.channels; ++c) {
        if (!channels[c]) continue;
        const GltfChannel& wanted = *channels[c];
        const TexelData* data = wanted.image != nullptr ? &texelsOf(*wanted.image) : nullptr;
        for (std::uint32_t y = 0; y < packed.height; ++y)
            for (std::uint32_t x = 0; x < packed.width; ++x) {
                double value = wanted.offset;
                if (data != nullptr) {
                    const std::uint64_t row = std::uint64_t{y} * data->height / packed.height;
                    const std::uint64_t column = std::uint64_t{x} * data->width / packed.width;
                    value += wanted.scale *
                             valueAt(*data, row * data->width + column, wanted.channel, wanted.image->colorSpace);
                }
                value = std::clamp(value, 0.0, 1.0);
                if (space == ColorSpace::Srgb && c < 3) value = encode(value);
                packed.texels[(std::size_t{y} * packed.width + x) * packed.channels + c] =
                    static_cast<std::uint8_t>(std::lround(255 * value));
            }
    }
    return packed;
}

} // namespace rt::scene
