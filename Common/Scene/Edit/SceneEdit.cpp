#include "Common/Scene/Edit/SceneEdit.h"

#include <iterator>
#include <map>
#include <type_traits>
#include <utility>

namespace rt::scene {

namespace {

using Position = std::vector<ObjectDesc>::iterator::difference_type;

template <typename Value>
void exchangeNamed(std::map<std::string, Value>& section, const std::string& name, std::optional<Value>& value) {
    std::optional<Value> before;
    if (auto node = section.extract(name)) before = std::move(node.mapped());
    if (value) section.emplace(name, std::move(*value));
    value = std::move(before);
}

struct Exchange {
    SceneDesc& scene;

    void operator()(SetObject& edit) const { std::swap(*findObject(scene, edit.path), edit.object); }
    void operator()(SetTransform& edit) const {
        std::swap(*transformOf(*findObject(scene, edit.path)), edit.transform);
    }
    void operator()(SetMaterialOf& edit) const {
        std::swap(*materialNameOf(*findObject(scene, edit.path)), edit.material);
    }
    void operator()(SetHidden& edit) const { std::swap(findObject(scene, edit.path)->hidden, edit.isHidden); }
    void operator()(PlaceObject& edit) const {
        std::vector<ObjectDesc>& list = *listOf(scene, edit.path);
        const auto at = list.begin() + static_cast<Position>(edit.path.indices.back());
        if (edit.object) {
            list.insert(at, std::move(*edit.object));
            edit.object.reset();
        } else {
            edit.object = std::move(*at);
            list.erase(at);
        }
    }
    void operator()(WrapObject& edit) const {
        ObjectDesc& object = *findObject(scene, edit.path);
        if (edit.transform) {
            GroupDesc group;
            group.transform = std::move(*edit.transform);
            group.objects.push_back(std::move(object));
            object = ObjectDesc{std::move(group), edit.isHidden};
            edit.transform.reset();
        } else {
            GroupDesc group = std::move(std::get<GroupDesc>(object.shape));
            edit.transform = std::move(group.transform);
            edit.isHidden = object.hidden;
            object = std::move(group.objects.front());
        }
    }
    void operator()(SetMaterial& edit) const { exchangeNamed(scene.materials, edit.name, edit.value); }
    void operator()(SetTexture& edit) const { exchangeNamed(scene.textures, edit.name, edit.value); }
    void operator()(SetPrototype& edit) const { exchangeNamed(scene.prototypes, edit.name, edit.value); }
    void operator()(SetModel& edit) const {
        if (edit.value)
            addContents(scene, std::exchange(edit.contents, {}));
        else
            edit.contents = takeContents(scene, edit.name);
        exchangeNamed(scene.models, edit.name, edit.value);
    }
    void operator()(SetCamera& edit) const { std::swap(scene.camera, edit.value); }
    void operator()(SetBackground& edit) const { std::swap(scene.background, edit.value); }
    void operator()(SetRenderDefaults& edit) const { std::swap(scene.render, edit.value); }
    void operator()(SetTargets& edit) const { std::swap(scene.importanceTargets, edit.value); }
    void operator()(SetTitle& edit) const { std::swap(scene.title, edit.value); }
};

template <typename Value>
std::size_t heapOf(const std::vector<Value>& values) {
    return values.capacity() * sizeof(Value);
}
std::size_t heapOf(const std::string& text) {
    return text.capacity() >= sizeof(std::string) ? text.capacity() + 1 : 0; // short ones lie in the string itself
}
std::size_t heapOf(const ObjectDesc& object) {
    return bytesOf(object) - sizeof object;
}
std::size_t heapOf(const std::vector<ObjectDesc>& objects) {
    std::size_t sum = objects.capacity() * sizeof(ObjectDesc);
    for (const ObjectDesc& object : objects) sum += heapOf(object);
    return sum;
}
template <class Real>
std::size_t heapOf(const MeshOf<Real>& mesh) {
    return heapOf(mesh.positions) + heapOf(mesh.normals) + heapOf(mesh.uvs) + heapOf(mesh.uvs2) + heapOf(mesh.colors) +
           heapOf(mesh.tangents) + heapOf(mesh.triangles);
}
std::size_t heapOf(const ObjectPath& path) {
    return heapOf(path.prototype) + heapOf(path.indices);
}

struct HeapOfObject {
    std::size_t operator()(const SphereSetDesc& spheres) const {
        return heapOf(spheres.centers) + heapOf(spheres.material);
    }
    std::size_t operator()(const MeshDesc& mesh) const {
        std::size_t sum = heapOf(mesh.material);
        if (const auto* data = std::get_if<Boxed<MeshData>>(&mesh.source)) sum += sizeof **data + heapOf(**data);
        if (const auto* data = std::get_if<Boxed<FloatMeshData>>(&mesh.source)) sum += sizeof **data + heapOf(**data);
        return sum;
    }
    std::size_t operator()(const GroupDesc& group) const { return heapOf(group.transform) + heapOf(group.objects); }
    std::size_t operator()(const InstanceDesc& instance) const {
        return heapOf(instance.prototype) + heapOf(instance.transform) + heapOf(instance.material);
    }
    std::size_t operator()(const MediumDesc&) const { return 0; }
    std::size_t operator()(const PointLightDesc&) const { return 0; }
    std::size_t operator()(const SpotLightDesc&) const { return 0; }
    std::size_t operator()(const DirectionalLightDesc&) const { return 0; }
    template <typename Surface>
    std::size_t operator()(const Surface& surface) const {
        return heapOf(surface.material);
    }
};

struct HeapOfEdit {
    std::size_t operator()(const SetObject& edit) const { return heapOf(edit.path) + heapOf(edit.object); }
    std::size_t operator()(const SetTransform& edit) const { return heapOf(edit.path) + heapOf(edit.transform); }
    std::size_t operator()(const SetMaterialOf& edit) const { return heapOf(edit.path) + heapOf(edit.material); }
    std::size_t operator()(const SetHidden& edit) const { return heapOf(edit.path); }
    std::size_t operator()(const PlaceObject& edit) const {
        return heapOf(edit.path) + (edit.object ? heapOf(*edit.object) : 0);
    }
    std::size_t operator()(const WrapObject& edit) const {
        return heapOf(edit.path) + (edit.transform ? heapOf(*edit.transform) : 0);
    }
    std::size_t operator()(const SetPrototype& edit) const {
        return heapOf(edit.name) + (edit.value ? heapOf(*edit.value) : 0);
    }
    std::size_t operator()(const SetModel& edit) const {
        std::size_t sum = heapOf(edit.name);
        for (const auto& [name, objects] : edit.contents.prototypes) sum += heapOf(name) + heapOf(objects);
        for (const auto& [name, material] : edit.contents.materials) sum += heapOf(name) + sizeof material;
        for (const auto& [name, texture] : edit.contents.textures) sum += heapOf(name) + sizeof texture;
        return sum;
    }
    std::size_t operator()(const SetTargets& edit) const { return heapOf(edit.value); }
    template <typename Edit>
    std::size_t operator()(const Edit& edit) const { // texts within are short, of files at most some hundred bytes
        if constexpr (requires { edit.name; }) return heapOf(edit.name);
        return 0;
    }
};

} // namespace

void exchange(SceneDesc& scene, SceneEdit& edit) {
    std::visit(Exchange{scene}, edit);
}

bool changesStructure(const SceneEdit& edit) {
    const auto* set = std::get_if<SetObject>(&edit);
    return std::holds_alternative<PlaceObject>(edit) || std::holds_alternative<WrapObject>(edit) ||
           std::holds_alternative<SetPrototype>(edit) || std::holds_alternative<SetModel>(edit) ||
           (set != nullptr && std::holds_alternative<GroupDesc>(set->object.shape));
}

std::optional<ObjectPath> placeAfter(const SceneEdit& edit, ObjectPath path) {
    if (const auto* placed = std::get_if<PlaceObject>(&edit)) {
        ObjectPath list = placed->path;
        const std::uint32_t at = list.indices.back();
        list.indices.pop_back();
        if (!path.isWithin(list)) return path;
        std::uint32_t& index = path.indices[list.indices.size()];
        if (!placed->object && index == at) return std::nullopt;
        if (placed->object && index >= at) ++index;
        if (!placed->object && index > at) --index;
    }
    if (const auto* wrapped = std::get_if<WrapObject>(&edit)) {
        if (!path.isWithin(wrapped->path)) return path;
        const auto inner = path.indices.begin() + static_cast<std::ptrdiff_t>(wrapped->path.indices.size());
        wrapped->transform ? (void)path.indices.insert(inner, 0) : (void)path.indices.erase(inner);
    }
    return path;
}

bool replaces(const SceneEdit& later, const SceneEdit& earlier) {
    const auto* moved = std::get_if<SetTransform>(&later);
    const auto* wrapped = std::get_if<WrapObject>(&earlier);
    if (moved != nullptr && wrapped != nullptr) return !wrapped->transform && wrapped->path == moved->path;
    if (later.index() != earlier.index()) return false;
    return std::visit(
        [&]<typename Edit>(const Edit& edit) {
            const Edit& other = std::get<Edit>(earlier);
            if constexpr (std::is_same_v<Edit, PlaceObject> || std::is_same_v<Edit, WrapObject> ||
                          std::is_same_v<Edit, SetModel>)
                return false;
            else if constexpr (requires { edit.path; })
                return edit.path == other.path;
            else if constexpr (requires { edit.name; })
                return edit.name == other.name;
            else
                return true; // of what there is once
        },
        later);
}

std::size_t bytesOf(const SceneEdit& edit) {
    return sizeof edit + std::visit(HeapOfEdit{}, edit);
}

std::size_t bytesOf(const ObjectDesc& object) {
    return sizeof object + std::visit(HeapOfObject{}, object.shape);
}

} // namespace rt::scene
