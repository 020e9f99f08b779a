#include "Common/Scene/Compiler/InstancePlan.h"

#include <algorithm>

#include "Common/Core/Error.h"
#include "Common/Scene/Origins.h"

namespace rt::scene {

namespace {

constexpr std::size_t kSharedPrimitives = 64; // below it an instance costs more than copies of the primitives
constexpr double kMaxInstances = 1 << 24;
constexpr std::size_t kMaxPrototypeDepth = 64;
constexpr double kMaxPrimitives = 1 << 28;

} // namespace

InstancePlan::InstancePlan(const SceneDesc& desc, const MaterialTable& materials, ModelCache& models,
                           const Affine& toWorld)
    : desc_(desc), materials_(materials), models_(models) {
    if (instanceCount(desc.objects, "/objects") > kMaxInstances)
        throw InputError(desc_.id + ": the scene comes to more than 2^24 instances");
    find(desc.objects, toWorld, nullptr, std::nullopt);
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

double InstancePlan::instanceCount(const std::vector<ObjectDesc>& objects, const std::string& place) {
    double sum = 0;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (objects[i].hidden) continue;
        const auto at = [&] { return place + "/" + std::to_string(i); };
        if (const auto* group = std::get_if<GroupDesc>(&objects[i].shape))
            sum += instanceCount(group->objects, at() + "/objects");
        else if (const auto* instance = std::get_if<InstanceDesc>(&objects[i].shape))
            sum += 1 + instanceCount(*instance, at());
    }
    return sum;
}

// Of each prototype once, however often it appears.
double InstancePlan::instanceCount(const InstanceDesc& instance, const std::string& place) {
    const std::string& name = instance.prototype;
    const auto fail = [&](const std::string& message) { throw InputError(desc_.id + ": " + place + ": " + message); };
    const auto prototype = desc_.prototypes.find(name);
    if (prototype == desc_.prototypes.end()) fail("prototype \"" + name + "\" is not defined");
    if (std::find(open_.begin(), open_.end(), name) != open_.end()) fail("prototype \"" + name + "\" contains itself");
    const auto known = instanceCounts_.find(name);
    if (known != instanceCounts_.end()) return known->second;
    if (open_.size() >= kMaxPrototypeDepth)
        fail("prototypes are nested deeper than " + std::to_string(kMaxPrototypeDepth));
    open_.push_back(name);
    const double count = instanceCount(prototype->second, "/prototypes/" + name);
    open_.pop_back();
    return instanceCounts_[name] = count;
}

// `instance`: that the objects come from; none: they are the scene's own.
void InstancePlan::find(const std::vector<ObjectDesc>& objects, const Affine& toWorld, const MaterialDesc* material,
                        const std::optional<std::uint32_t>& instance) {
    for (const ObjectDesc& object : objects) {
        if (object.hidden) {
            if (!instance) nextObject_ += leafCount(object);
            continue;
        }
        if (const auto* group = std::get_if<GroupDesc>(&object.shape)) {
            find(group->objects, toWorld * toAffine(group->transform), material, instance);
            continue;
        }
        const std::uint32_t number = instance ? *instance : nextObject_++;
        const auto* placedOne = std::get_if<InstanceDesc>(&object.shape);
        if (placedOne == nullptr) continue;
        const Affine placed = toWorld * toAffine(placedOne->transform);
        const bool replaces = !material && !placedOne->material.empty();
        const MaterialDesc* chosen = replaces ? &materials_.find(placedOne->material) : material;
        prototypes_[placedOne->prototype].occurrences.push_back({placed, chosen, number});
        find(desc_.prototypes.at(placedOne->prototype), placed, chosen, number);
    }
}

std::size_t InstancePlan::primitiveCount(const std::vector<ObjectDesc>& objects) {
    std::size_t sum = 0;
    for (const ObjectDesc& object : objects) {
        const auto& shape = object.shape;
        if (object.hidden) continue;
        if (const auto* spheres = std::get_if<SphereSetDesc>(&shape))
            sum += spheres->centers.size();
        else if (const auto* mesh = std::get_if<MeshDesc>(&shape))
            sum += models_.triangleCount(*mesh);
        else if (const auto* group = std::get_if<GroupDesc>(&shape))
            sum += primitiveCount(group->objects);
        else if (std::holds_alternative<BoxDesc>(shape))
            sum += 6;
        else if (std::holds_alternative<SphereDesc>(shape) || std::holds_alternative<QuadDesc>(shape) ||
                 std::holds_alternative<DiskDesc>(shape) || std::holds_alternative<CylinderDesc>(shape))
            sum += 1;
    }
    return sum;
}

} // namespace rt::scene
