// Materials and textures of a glTF file as those of a scene.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "Common/Scene/Gltf/GltfFile.h"
#include "Common/Scene/SceneDesc.h"
#include "Common/Scene/UniqueNames.h"

namespace rt::scene {

class GltfMaterials {
  public:
    struct Use {
        std::string name;
        bool isOpaque = true;                    // nothing of it depends on opacity
        bool isUnlit = false;                    // it is as bright as its colour
        std::optional<std::uint32_t> tangentSet; // of the texture coordinates of its normal map
    };

    // Adds all materials with their textures to the scene, and a notice for each kind of thing that is left out. Both
    // must outlive this.
    GltfMaterials(const GltfFile& file, SceneDesc& scene);

    // Of a primitive; -1: the material of primitives without one.
    const Use& use(int material);
    bool emitsAsLight() const { return emitsAsLight_; } // some material is brighter than white

  private:
    struct Slot; // a texture as a material refers to it

    void add(std::size_t index);
    std::string texture(const Slot& slot, ColorSpace space, const glm::dvec3& tint, const std::string& place);
    NumberOrTexture number(double factor, const Slot& slot, Channel channel, const std::string& place);
    ColorOrTexture color(const glm::dvec3& factor, const Slot& slot, const std::string& place);
    void addExtensions(const tinygltf::Material& source, const std::string& place, MaterialDesc& material);
    void leaveOut(const std::string& what);

    const GltfFile& file_;
    SceneDesc& scene_;
    UniqueNames names_;
    std::vector<Use> uses_;
    std::optional<Use> plain_;
    std::map<std::string, int> leftOut_;
    bool emitsAsLight_ = false;
};

} // namespace rt::scene
