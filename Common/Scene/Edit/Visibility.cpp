#include "Common/Scene/Edit/Visibility.h"

#include <algorithm>
#include <string>

namespace rt::scene {

namespace {

bool isEmitter(const SceneDesc& scene, const std::string& name) {
    const auto material = scene.materials.find(name);
    return material != scene.materials.end() && material->second.emission != glm::dvec3(0);
}

bool anyGivesLight(const SceneDesc& scene, const std::vector<ObjectDesc>& objects) {
    return std::any_of(objects.begin(), objects.end(),
                       [&](const ObjectDesc& object) { return givesLight(scene, object); });
}

struct GivesLight {
    const SceneDesc& scene;

    bool operator()(const PointLightDesc&) const { return true; }
    bool operator()(const SpotLightDesc&) const { return true; }
    bool operator()(const DirectionalLightDesc&) const { return true; }
    bool operator()(const MediumDesc&) const { return false; }
    bool operator()(const GroupDesc& group) const { return anyGivesLight(scene, group.objects); }
    bool operator()(const InstanceDesc& instance) const {
        if (!instance.material.empty()) return isEmitter(scene, instance.material);
        const auto prototype = scene.prototypes.find(instance.prototype);
        return prototype != scene.prototypes.end() && anyGivesLight(scene, prototype->second);
    }
    template <typename Surface>
    bool operator()(const Surface& surface) const {
        return isEmitter(scene, surface.material);
    }
};

// Calls visit(path, object) for each of the list; of a group for what is in it, too, where that returns true.
template <typename Visit>
void walkObjects(const std::vector<ObjectDesc>& objects, ObjectPath& list, const Visit& visit) {
    list.indices.push_back(0);
    for (std::uint32_t i = 0; i < objects.size(); ++i) {
        list.indices.back() = i;
        const auto* group = std::get_if<GroupDesc>(&objects[i].shape);
        if (visit(list, objects[i]) && group != nullptr) walkObjects(group->objects, list, visit);
    }
    list.indices.pop_back();
}

} // namespace

bool givesLight(const SceneDesc& scene, const ObjectDesc& object) {
    return std::visit(GivesLight{scene}, object.shape);
}

bool isShown(const SceneDesc& scene, const ObjectPath& path) {
    ObjectPath part = path;
    for (; !part.indices.empty(); part.indices.pop_back())
        if (const ObjectDesc* object = findObject(scene, part); object != nullptr && object->hidden) return false;
    return true;
}

std::vector<SceneEdit> hidden(const SceneDesc& scene, const std::vector<ObjectPath>& paths, bool isHidden) {
    std::vector<SceneEdit> edits;
    for (const ObjectPath& path : paths)
        if (findObject(scene, path)->hidden != isHidden) edits.emplace_back(SetHidden{path, isHidden});
    return edits;
}

std::vector<SceneEdit> allShown(const SceneDesc& scene) {
    std::vector<SceneEdit> edits;
    ObjectPath list;
    walkObjects(scene.objects, list, [&](const ObjectPath& path, const ObjectDesc& object) {
        if (object.hidden) edits.emplace_back(SetHidden{path, false});
        return true;
    });
    return edits;
}

std::vector<SceneEdit> soloed(const SceneDesc& scene, const std::vector<ObjectPath>& paths) {
    std::vector<SceneEdit> edits;
    ObjectPath list;
    walkObjects(scene.objects, list, [&](const ObjectPath& path, const ObjectDesc& object) {
        const auto next = std::lower_bound(paths.begin(), paths.end(), path);
        const bool isChosen = next != paths.end() && *next == path;
        const bool isAround = next != paths.end() && next->isWithin(path);
        const bool isLight = !isChosen && !isAround && givesLight(scene, object);
        if (!isLight && object.hidden == (isChosen || isAround)) edits.emplace_back(SetHidden{path, !object.hidden});
        return isAround || isLight;
    });
    return edits;
}

} // namespace rt::scene
