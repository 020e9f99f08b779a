// Materials and textures of a glTF file as those of a scene.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "Common/Scene/Gltf/GltfFile.h"
#include "Common/Scene/Gltf/GltfTextures.h"
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
        bool isStretched = false;                // tangents matter without texture coordinates, too
    };

    // Adds all materials with their textures to the scene, and a notice for each kind of thing that is left out. Both
    // must outlive this.
    GltfMaterials(const GltfFile& file, SceneDesc& scene);

    // Of a primitive; -1: the material of primitives without one.
    const Use& use(int material);

  private:
    void add(std::size_t index);
    MaterialDesc unlit(const tinygltf::Material& source);
    MaterialDesc lit(const tinygltf::Material& source);
    static void setOpacity(double factor, const std::string& texture, MaterialDesc& material);
    double addMetallicRoughness(const tinygltf::Material& source, MaterialDesc& material);
    double addSpecularGlossiness(const tinygltf::Value& source, MaterialDesc& material);
    void addClearcoat(const tinygltf::Value& coat, PrincipledDesc& p);
    void addAnisotropy(const tinygltf::Value& anisotropy, PrincipledDesc& p);
    void addIridescence(const tinygltf::Value& iridescence, PrincipledDesc& p);
    void addDielectric(const tinygltf::ExtensionMap& extensions, PrincipledDesc& p);
    void addSpecular(const tinygltf::Value& specular, PrincipledDesc& p);

    const GltfFile& file_;
    SceneDesc& scene_;
    UniqueNames names_;
    GltfTextures textures_;
    std::vector<Use> uses_;
    std::optional<Use> plain_;
};

} // namespace rt::scene
