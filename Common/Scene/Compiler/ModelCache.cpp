#include "Common/Scene/Compiler/ModelCache.h"

#include "Common/Scene/Builtin/Placeholders.h"
#include "Common/Scene/Compiler/CompileMemory.h"

namespace rt::scene {

ModelCache::ModelCache(const SceneDesc& desc, const CompileOptions& options, CompiledScene& out, TextureTable& textures,
                       MaterialTable& materials)
    : desc_(desc), options_(options), out_(out), textures_(textures), materials_(materials) {
    materials_.setName(plain_, "plain");
}

// Once for all compilations that have a memory in common.
std::shared_ptr<const ObjModel> ModelCache::read(const std::string& key, const std::function<ObjModel()>& make) const {
    if (options_.memory == nullptr) return std::make_shared<const ObjModel>(make());
    std::shared_ptr<const ObjModel>& kept = options_.memory->models[key];
    if (!kept) kept = std::make_shared<const ObjModel>(make());
    return kept;
}

const ObjModel& ModelCache::model(const MeshFile& source, bool withMaterials) {
    const std::string key = source.file + '\n' + source.standIn + (withMaterials ? "\n+" : "\n-");
    const auto [entry, isNew] = models_.try_emplace(key);
    if (!isNew) return *entry->second;
    if (const auto path = locateAsset(source.file, source.standIn, options_, desc_.id, out_.notices)) {
        const auto load = [&] { return loadObj(*path, withMaterials, source.file + "/"); };
        entry->second = read(key, load);
        textures_.add(entry->second->textures);
        for (const auto& [name, material] : entry->second->materials)
            materials_.setName(material, name.substr(source.file.size() + 1));
        const std::vector<std::string>& notices = entry->second->notices;
        out_.notices.insert(out_.notices.end(), notices.begin(), notices.end());
    } else {
        out_.notices.push_back(source.file + ": a generated mesh stands in");
        const auto standIn = [&] { return ObjModel{{{{}, makeMeshStandIn(source.standIn)}}, {}, {}, {}}; };
        entry->second = read("\n" + source.standIn, standIn);
    }
    return *entry->second;
}

std::vector<ModelCache::Part> ModelCache::parts(const MeshDesc& object) {
    if (const auto* data = std::get_if<Boxed<MeshData>>(&object.source))
        return {{&**data, &materials_.find(object.material)}};
    if (const auto* data = std::get_if<Boxed<FloatMeshData>>(&object.source))
        return {{&**data, &materials_.find(object.material)}};
    const bool hasOwn = object.material.empty();
    const ObjModel& model = this->model(std::get<MeshFile>(object.source), hasOwn);
    std::vector<Part> parts;
    for (const ObjPart& part : model.parts) {
        const MaterialDesc* material = &plain_;
        if (!hasOwn)
            material = &materials_.find(object.material);
        else if (!part.material.empty())
            material = &model.materials.at(part.material);
        parts.push_back({&part.mesh, material, part.isUnlit});
    }
    return parts;
}

std::size_t ModelCache::triangleCount(const MeshDesc& object) {
    std::size_t count = 0;
    if (const auto* data = std::get_if<Boxed<MeshData>>(&object.source)) return (*data)->triangles.size();
    if (const auto* data = std::get_if<Boxed<FloatMeshData>>(&object.source)) return (*data)->triangles.size();
    for (const ObjPart& part : model(std::get<MeshFile>(object.source), object.material.empty()).parts)
        count += part.mesh.triangles.size();
    return count;
}

} // namespace rt::scene
