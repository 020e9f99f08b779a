#include "Common/Scene/InstancePlan.h"

#include <algorithm>

#include "Common/Core/Error.h"

namespace rt::scene {

namespace {

constexpr std::size_t kSharedPrimitives = 64;  // below it an instance costs more than copies of the primitives
constexpr std::size_t kMaxOccurrences = std::size_t{1} << 24;
constexpr double kMaxPrimitives = 1 << 28;

}  // namespace

InstancePlan::InstancePlan(const SceneDesc& desc, const MaterialTable& materials, ModelCache& models,
                           const Affine& toWorld)
    : desc_(desc), materials_(materials), models_(models) {
    find(desc.objects, toWorld, nullptr, "/objects");
    double total = static_cast<double>(primitiveCount(desc.objects));
    for (auto& [name, prototype] : prototypes_) {
        prototype.objects = &desc.prototypes.at(name);
        const std::size_t count = primitiveCount(*prototype.objects);
        prototype.isShared = prototype.occurrences.size() > 1 && count >= kSharedPrimitives;
        total +=
            static_cast<double>(count) * static_cast<double>(prototype.isShared ? 1 : prototype.occurrences.size());
    }
    if (total > kMaxPrimitives) throw InputError(desc_.id + ": the scene comes to more than 2^28 primitives");
}

void InstancePlan::find(const std::vector<ObjectDesc>& objects, const Affine& toWorld, const MaterialDesc* material,
                        const std::string& place) {
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (const auto* group = std::get_if<GroupDesc>(&objects[i].shape))
            find(group->objects, toWorld * toAffine(group->transform), material,
                 place + "/" + std::to_string(i) + "/objects");
        else if (const auto* instance = std::get_if<InstanceDesc>(&objects[i].shape))
            enter(*instance, toWorld, material, place + "/" + std::to_string(i));
    }
}

void InstancePlan::enter(const InstanceDesc& instance, const Affine& toWorld, const MaterialDesc* material,
                         const std::string& place) {
    const std::string& name = instance.prototype;
    const auto fail = [&](const std::string& message) { throw InputError(desc_.id + ": " + place + ": " + message); };
    const auto prototype = desc_.prototypes.find(name);
    if (prototype == desc_.prototypes.end()) fail("prototype \"" + name + "\" is not defined");
    if (std::find(open_.begin(), open_.end(), name) != open_.end()) fail("prototype \"" + name + "\" contains itself");
    if (++count_ > kMaxOccurrences) fail("more than 2^24 instances");
    if (!material && !instance.material.empty()) material = &materials_.find(instance.material);
    const Affine placed = toWorld * toAffine(instance.transform);
    prototypes_[name].occurrences.push_back({placed, material});
    open_.push_back(name);
    find(prototype->second, placed, material, "/prototypes/" + name);
    open_.pop_back();
}

std::size_t InstancePlan::primitiveCount(const std::vector<ObjectDesc>& objects) {
    std::size_t sum = 0;
    for (const ObjectDesc& object : objects) {
        const auto& shape = object.shape;
        if (const auto* spheres = std::get_if<SphereSetDesc>(&shape))
            sum += spheres->centers.size();
        else if (const auto* mesh = std::get_if<MeshDesc>(&shape))
            sum += models_.triangleCount(*mesh);
        else if (const auto* group = std::get_if<GroupDesc>(&shape))
            sum += primitiveCount(group->objects);
        else if (std::holds_alternative<BoxDesc>(shape))
            sum += 6;
        else if (std::holds_alternative<SphereDesc>(shape) || std::holds_alternative<QuadDesc>(shape))
            sum += 1;
    }
    return sum;
}

}  // namespace rt::scene
