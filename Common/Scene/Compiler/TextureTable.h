// Textures, images and Perlin tables of the compiled scene; each is made when something first refers to it.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "Common/Scene/CompiledScene.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/SceneDesc.h"
#include "Common/Shared/Texture/Checker.h"

namespace rt::scene {

class TextureTable {
  public:
    // All references must outlive the table.
    TextureTable(const SceneDesc& desc, const CompileOptions& options, CompiledScene& out);

    // Makes the textures of a model file known.
    void add(const std::map<std::string, TextureDesc>& textures) { library_.insert(textures.begin(), textures.end()); }
    // Index of the texture, or kNone and `color` set for a constant.
    std::uint32_t resolve(const ColorOrTexture& source, shared::vec3& color);
    // Index into images of a source, of which wrapping and coordinates do not count; files and stand-ins are read once
    // each. Throws InputError when there is neither.
    std::uint32_t image(const ImageTexture& source);
    // Makes the images of textures, those of checkers included, on all threads; in their order. Names that are not
    // defined are passed over.
    void loadImages(const std::vector<std::string>& textures);
    // Whether a texture depends on texture coordinates: an image, or a checker of images (or nested deeper than
    // `depth`).
    bool mayShowImage(const std::string& name, int depth = shared::kMaxCheckerDepth) const;
    // Whether a texture shows an image whose channels are alike: as a map of normals it would be one of heights.
    bool isGreyImage(std::uint32_t texture) const;
    // Mean colour of a texture: exact over an image or a checker, 0.5 of the tint for noise.
    glm::dvec3 mean(std::uint32_t texture) const;

  private:
    std::uint32_t named(const std::string& name);
    std::uint32_t child(const ColorOrTexture& source);
    int nesting(const shared::Texture& texture) const; // checkers on the longest way down from it, itself included
    shared::Texture record(const TextureDesc& desc);
    void findImages(const std::string& name, int depth, std::vector<const ImageTexture*>& found) const;
    void loadImages(const std::vector<const ImageTexture*>& sources);
    EncodedTexels open(const ImageTexture& source);
    EncodedTexels openFile(const ImageTexture& source, const std::filesystem::path& path) const;
    void decode(const std::vector<const ImageTexture*>& images, std::vector<EncodedTexels>& encoded);
    void append(const ImageTexture& source, TexelData data);

    const std::string id_; // of the scene, for errors
    std::map<std::string, TextureDesc> library_;
    const CompileOptions& options_;
    CompiledScene& out_;
    std::map<std::string, std::uint32_t> named_; // kNone: being made
    std::map<std::string, std::uint32_t> images_;
    int depth_ = 0;                                 // of checkers being made
    std::map<std::uint32_t, std::uint32_t> perlin_; // by seed
};

// Linear colour of a texel of a compiled image.
glm::dvec3 texelColor(const CompiledScene& scene, const shared::Image& image, std::uint32_t x, std::uint32_t y);

} // namespace rt::scene
