#include "Common/Scene/Edit/ObjectPath.h"

#include <algorithm>
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

// Through the lists in the order of the paths, which is that of the leaves.
class LeafSearch {
  public:
    explicit LeafSearch(std::span<const ObjectPath> paths) : paths_(paths), ranges_(paths.size()) {}

    void go(const std::vector<ObjectDesc>& objects) {
        at_.indices.push_back(0);
        for (std::uint32_t i = 0; i < objects.size() && next_ < paths_.size(); ++i) {
            at_.indices.back() = i;
            while (next_ < paths_.size() && paths_[next_] < at_) ranges_[next_++].first = leaf_; // there is no such one
            const bool isWanted = next_ < paths_.size() && paths_[next_] == at_;
            const auto* group = std::get_if<GroupDesc>(&objects[i].shape);
            if (isWanted) {
                const std::uint32_t count = leafCount(objects[i]);
                ranges_[next_++] = {leaf_, count};
                leaf_ += count;
            } else if (group != nullptr) {
                go(group->objects);
            } else {
                ++leaf_;
            }
        }
        at_.indices.pop_back();
    }
    std::vector<ObjectRange> ranges() {
        for (; next_ < paths_.size(); ++next_) ranges_[next_].first = leaf_;
        return std::move(ranges_);
    }

  private:
    std::span<const ObjectPath> paths_;
    std::vector<ObjectRange> ranges_;
    std::size_t next_ = 0; // of the paths
    std::uint32_t leaf_ = 0;
    ObjectPath at_;
};

} // namespace

ObjectPath ObjectPath::child(std::size_t index) const {
    ObjectPath path = *this;
    path.indices.push_back(static_cast<std::uint32_t>(index));
    return path;
}

bool ObjectPath::isWithin(const ObjectPath& group) const {
    return prototype == group.prototype && indices.size() > group.indices.size() &&
           std::equal(group.indices.begin(), group.indices.end(), indices.begin());
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

std::vector<ObjectRange> leavesOf(const SceneDesc& scene, std::span<const ObjectPath> paths) {
    LeafSearch search(paths);
    search.go(scene.objects);
    return search.ranges();
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
