// Textures of a glTF file as those of a scene.
#pragma once
#include <cstddef>
#include <map>
#include <set>
#include <string>

#include <glm/vec3.hpp>

#include "Common/Scene/Gltf/GltfFile.h"
#include "Common/Scene/Gltf/GltfValues.h"
#include "Common/Scene/SceneDesc.h"
#include "Common/Scene/UniqueNames.h"

namespace rt::scene {

// A texture as a material refers to it.
struct GltfSlot {
    int index = -1; // of a texture; -1: none
    int set = 0;    // of texture coordinates
    const tinygltf::Value* transform = nullptr;

    GltfSlot() = default;
    template <typename Info>
    explicit GltfSlot(const Info& info)
        : index(info.index), set(info.texCoord), transform(extension(info.extensions, "KHR_texture_transform")) {
        overrideSet();
    }
    GltfSlot(const tinygltf::Value& object, const char* key);

  private:
    void overrideSet();
};

class GltfTextures {
  public:
    // All must outlive this.
    GltfTextures(const GltfFile& file, SceneDesc& scene, UniqueNames& names)
        : file_(file), scene_(scene), names_(names) {}

    // Of which material the next textures are.
    void begin(std::size_t material) { material_ = material; }

    // Name of a texture of the scene; empty where the slot has none, or none that can be shown.
    std::string texture(const GltfSlot& slot, ColorSpace space, const glm::dvec3& tint);
    NumberOrTexture number(double factor, const GltfSlot& slot, Channel channel); // factor within [0,1]
    ColorOrTexture color(const glm::dvec3& factor, const GltfSlot& slot);         // likewise

    // Of the material: "WHAT of N materials is left out".
    void leaveOut(const std::string& what) { leftOut_[what].insert(material_); }
    void addNotices();

  private:
    bool locate(std::size_t image, ImageTexture& texture);

    const GltfFile& file_;
    SceneDesc& scene_;
    UniqueNames& names_;
    std::size_t material_ = 0;
    std::map<std::string, std::set<std::size_t>> leftOut_; // of which materials
    std::set<std::string> missing_;                        // images
};

} // namespace rt::scene
