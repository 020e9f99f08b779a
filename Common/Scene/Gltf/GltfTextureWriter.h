// Textures of a scene as those of a glTF file.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Gltf/GltfDocument.h"
#include "Common/Scene/Gltf/GltfFile.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// What reads and writes images, which this library does not; without it images that glTF cannot have as they are, are
// left out.
struct GltfImageTools {
    // As CompileOptions::loadTexels.
    std::function<EncodedTexels(const std::filesystem::path&, std::optional<std::uint32_t>)> loadTexels;
    // Rows from the top of 3 or 4 bytes a texel as a PNG.
    std::function<std::vector<std::byte>(std::uint32_t width, std::uint32_t height, std::uint32_t channels,
                                         const std::vector<std::uint8_t>& texels)>
        encodePng;
};

// What a channel of a glTF texture is to hold: offset + scale * channel of an image.
struct GltfChannel {
    const ImageTexture* image = nullptr; // null: the offset alone
    Channel channel = Channel::Red;
    double scale = 1, offset = 0;
};
using GltfChannels = std::array<std::optional<GltfChannel>, 4>; // unset: whatever there is

class GltfTextureWriter {
  public:
    // All must outlive this.
    GltfTextureWriter(const SceneDesc& scene, const GltfImageTools& tools, GltfDocument& document, GltfNotices& notices)
        : scene_(scene), tools_(tools), document_(document), notices_(notices) {}

    // Of models that objects name.
    void add(const std::map<std::string, TextureDesc>& textures) { more_.insert(textures.begin(), textures.end()); }

    // Null: it is of a formula.
    const ImageTexture* imageOf(const std::string& texture) const;
    // What stands for one that is no image: the mean, with a notice where it is not one colour.
    glm::dvec3 colorOf(const std::string& texture);

    // A textureInfo. `space`: how the slot's colours are encoded. Nothing, and a notice, where there is no such image
    // or it cannot be written.
    std::optional<OrderedJson> info(const GltfChannels& channels, ColorSpace space);

  private:
    struct Encoded {
        std::vector<std::byte> content; // empty: there is no such image
        std::string name;               // of a texture that shows it
    };
    const TextureDesc& find(const std::string& texture) const;
    glm::dvec3 meanOf(const ColorOrTexture& source, int depth) const;
    bool fits(const GltfChannels& channels, ColorSpace space, const ImageTexture& image);
    const Encoded& encoded(const ImageTexture& image);
    Encoded read(const ImageTexture& image);
    std::string nameOf(const ImageTexture& image) const;
    int whole(const ImageTexture& image);                                        // of the document's images
    std::optional<int> composed(const GltfChannels& channels, ColorSpace space); // likewise, made for it
    std::optional<TexelData> decoded(const ImageTexture& image);
    int sampler(const ImageTexture& image);
    void addTransform(const ImageTexture& image, OrderedJson& info);

    const SceneDesc& scene_;
    const GltfImageTools& tools_;
    GltfDocument& document_;
    GltfNotices& notices_;
    std::map<std::string, TextureDesc> more_;
    std::map<std::filesystem::path, GltfImages> files_; // of glTF, that images lie in
    std::map<std::string, Encoded> encoded_;            // by what is read
    std::map<std::string, int> images_, samplers_, textures_;
};

} // namespace rt::scene
