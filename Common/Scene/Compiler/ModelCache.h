// Meshes that objects refer to, each file read once.
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "Common/Scene/Compiler/MaterialTable.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Compiler/TextureTable.h"
#include "Common/Scene/Obj/ObjLoader.h"

namespace rt::scene {

class ModelCache {
  public:
    ModelCache(const SceneDesc& desc, const CompileOptions& options, CompiledScene& out, TextureTable& textures,
               MaterialTable& materials);

    struct Part {
        std::variant<const MeshData*, const FloatMeshData*> mesh;
        const MaterialDesc* material;
        bool isUnlit = false; // no light, whatever it emits
    };
    // Surfaces of an object with their own materials; everything stays valid as long as the cache. Throws InputError.
    std::vector<Part> parts(const MeshDesc& object);
    std::size_t triangleCount(const MeshDesc& object);

  private:
    const ObjModel& model(const MeshFile& source, bool withMaterials);
    std::shared_ptr<const ObjModel> read(const std::string& key, const std::function<ObjModel()>& make) const;

    const SceneDesc& desc_;
    const CompileOptions& options_;
    CompiledScene& out_;
    TextureTable& textures_;
    MaterialTable& materials_;
    const MaterialDesc plain_ = plainMaterial();
    std::map<std::string, std::shared_ptr<const ObjModel>> models_;
};

} // namespace rt::scene
