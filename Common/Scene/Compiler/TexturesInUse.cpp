#include "Common/Scene/Compiler/TexturesInUse.h"

#include <set>

namespace rt::scene {

namespace {

class TextureSearch {
  public:
    TextureSearch(const MaterialTable& materials, ModelCache& models) : materials_(materials), models_(models) {}

    void add(const MaterialDesc& material) {
        if (!seen_.insert(&material).second) return;
        forEachTexture(material, [&](const std::string& name) { names_.push_back(name); });
    }
    void add(const std::vector<ObjectDesc>& objects) {
        for (const ObjectDesc& object : objects)
            if (!object.hidden) std::visit([&](const auto& shape) { addOne(shape); }, object.shape);
    }
    std::vector<std::string> names() { return std::move(names_); }

  private:
    template <typename Shape>
    void addOne(const Shape& shape) {
        if constexpr (requires { shape.light; }) add(materials_.find(shape.material)); // a surface
    }
    void addOne(const MeshDesc& mesh) {
        for (const ModelCache::Part& part : models_.parts(mesh)) add(*part.material);
    }
    void addOne(const MediumDesc& medium) {
        if (const auto* name = std::get_if<std::string>(&medium.albedo)) names_.push_back(*name);
    }
    void addOne(const GroupDesc& group) { add(group.objects); }
    void addOne(const InstanceDesc&) {} // the plan has them

    const MaterialTable& materials_;
    ModelCache& models_;
    std::set<const MaterialDesc*> seen_;
    std::vector<std::string> names_;
};

} // namespace

std::vector<std::string> texturesInUse(const SceneDesc& desc, const InstancePlan& plan, const MaterialTable& materials,
                                       ModelCache& models) {
    TextureSearch search(materials, models);
    search.add(desc.objects);
    for (const auto& [name, prototype] : plan.prototypes()) {
        bool keepsMaterials = false;
        for (const Occurrence& occurrence : prototype.occurrences)
            if (occurrence.material)
                search.add(*occurrence.material);
            else
                keepsMaterials = true;
        if (keepsMaterials) search.add(*prototype.objects);
    }
    return search.names();
}

} // namespace rt::scene
