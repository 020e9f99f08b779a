// Triangles of a scene as meshes of a glTF file.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "Common/Scene/Gltf/GltfDocument.h"
#include "Common/Scene/Gltf/GltfMaterialWriter.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

class GltfMeshWriter {
  public:
    // All must outlive this.
    GltfMeshWriter(GltfDocument& document, GltfMaterialWriter& materials, GltfNotices& notices)
        : document_(document), materials_(materials), notices_(notices) {}

    struct Surface {
        const MeshData* data; // which stays where it is: its accessors are written once
        std::string material;
    };
    // The mesh of these surfaces; the same for the same ones. Nothing where they have no triangles.
    std::optional<int> mesh(const std::vector<Surface>& surfaces, const std::string& name);
    // One that lives no longer than the call.
    std::optional<int> ownMesh(const MeshData& data, const std::string& material, const std::string& name);

  private:
    struct Accessors {
        OrderedJson attributes;
        int indices;
    };
    // `isTurned`: inside out. Vertex colours are of principled materials alone.
    Accessors write(const MeshData& data, bool isTurned, bool hasColors, bool hasOpacity);
    OrderedJson primitive(const MeshData& data, const std::string& material, bool isKept);

    GltfDocument& document_;
    GltfMaterialWriter& materials_;
    GltfNotices& notices_;
    std::map<std::tuple<const MeshData*, bool, bool, bool>, Accessors> accessors_;
    std::map<std::vector<std::pair<const MeshData*, std::string>>, int> meshes_;
};

} // namespace rt::scene
