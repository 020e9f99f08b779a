#include "Common/Scene/Edit/ObjectPath.h"

#include <utility>

namespace rt::scene {

namespace {

const std::vector<ObjectDesc>* findList(const SceneDesc& scene, const ObjectPath& path) {
    const std::vector<ObjectDesc>* list = &scene.objects;
    if (!path.prototype.empty()) {
        const auto prototype = scene.prototypes.find(path.prototype);
        if (prototype == scene.prototypes.end()) return nullptr;
        list = &prototype->second;
    }
    for (std::size_t depth = 0; depth + 1 < path.indices.size(); ++depth) {
        const std::uint32_t index = path.indices[depth];
        const auto* group = index < list->size() ? std::get_if<GroupDesc>(&(*list)[index].shape) : nullptr;
        if (group == nullptr) return nullptr;
        list = &group->objects;
    }
    return list;
}

std::uint32_t leafCount(const ObjectDesc& object) {
    const auto* group = std::get_if<GroupDesc>(&object.shape);
    if (group == nullptr) return 1;
    std::uint32_t sum = 0;
    for (const ObjectDesc& child : group->objects) sum += leafCount(child);
    return sum;
}

} // namespace

ObjectPath ObjectPath::child(std::size_t index) const {
    ObjectPath path = *this;
    path.indices.push_back(static_cast<std::uint32_t>(index));
    return path;
}

std::string textOf(const ObjectPath& path) {
    std::string text = path.prototype.empty() ? "/objects" : "/prototypes/" + path.prototype;
    for (std::size_t depth = 0; depth < path.indices.size(); ++depth)
        text += (depth > 0 ? "/objects/" : "/") + std::to_string(path.indices[depth]);
    return text;
}

const ObjectDesc* findObject(const SceneDesc& scene, const ObjectPath& path) {
    const std::vector<ObjectDesc>* list = path.indices.empty() ? nullptr : findList(scene, path);
    return list != nullptr && path.indices.back() < list->size() ? &(*list)[path.indices.back()] : nullptr;
}

ObjectDesc* findObject(SceneDesc& scene, const ObjectPath& path) {
    return const_cast<ObjectDesc*>(findObject(std::as_const(scene), path));
}

std::vector<ObjectDesc>* listOf(SceneDesc& scene, const ObjectPath& path) {
    return path.indices.empty() ? nullptr : const_cast<std::vector<ObjectDesc>*>(findList(scene, path));
}

Affine groupTransform(const SceneDesc& scene, const ObjectPath& path) {
    Affine map;
    ObjectPath outer = path;
    outer.indices.clear();
    for (std::size_t depth = 0; depth + 1 < path.indices.size(); ++depth) {
        outer.indices.push_back(path.indices[depth]);
        const ObjectDesc* object = findObject(scene, outer);
        const auto* group = object != nullptr ? std::get_if<GroupDesc>(&object->shape) : nullptr;
        if (group != nullptr) map = map * toAffine(group->transform);
    }
    return map;
}

ObjectPath pathOfLeaf(const SceneDesc& scene, std::uint32_t leaf) {
    ObjectPath path;
    const std::vector<ObjectDesc>* list = &scene.objects;
    for (std::size_t i = 0; i < list->size();) {
        const std::uint32_t count = leafCount((*list)[i]);
        if (leaf >= count) {
            leaf -= count;
            ++i;
            continue;
        }
        path.indices.push_back(static_cast<std::uint32_t>(i));
        const auto* group = std::get_if<GroupDesc>(&(*list)[i].shape);
        if (group == nullptr) return path;
        list = &group->objects;
        i = 0;
    }
    return {};
}

LeafRange leavesOf(const SceneDesc& scene, const ObjectPath& path) {
    if (!path.prototype.empty() || findObject(scene, path) == nullptr) return {};
    LeafRange range;
    const std::vector<ObjectDesc>* list = &scene.objects;
    for (const std::uint32_t index : path.indices) {
        for (std::uint32_t i = 0; i < index; ++i) range.first += leafCount((*list)[i]);
        const ObjectDesc& object = (*list)[index];
        range.count = leafCount(object);
        if (const auto* group = std::get_if<GroupDesc>(&object.shape)) list = &group->objects;
    }
    return range;
}

const std::string* materialNameOf(const ObjectDesc& object) {
    return std::visit(
        [](const auto& shape) -> const std::string* {
            if constexpr (requires { shape.material; }) return &shape.material;
            return nullptr;
        },
        object.shape);
}

std::string* materialNameOf(ObjectDesc& object) {
    return const_cast<std::string*>(materialNameOf(std::as_const(object)));
}

const Transform* transformOf(const ObjectDesc& object) {
    return std::visit(
        [](const auto& shape) -> const Transform* {
            if constexpr (requires { shape.transform; }) return &shape.transform;
            return nullptr;
        },
        object.shape);
}

Transform* transformOf(ObjectDesc& object) {
    return const_cast<Transform*>(transformOf(std::as_const(object)));
}

} // namespace rt::scene
