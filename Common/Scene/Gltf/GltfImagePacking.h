// Images whose channels come from several, as glTF wants them in one.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "Common/Scene/Gltf/GltfTextureWriter.h"

namespace rt::scene {

struct PackedImage {
    std::uint32_t width = 0, height = 0;
    std::uint32_t channels = 3; // 4 where opacity counts
    std::vector<std::uint8_t> texels;
};

// As large as the largest of them; others are repeated texel by texel. `space`: of the first three channels.
PackedImage packImage(const GltfChannels& channels, ColorSpace space,
                      const std::function<const TexelData&(const ImageTexture&)>& texelsOf);

} // namespace rt::scene
