#include "Common/Scene/Edit/MaterialTransfer.h"

#include "Common/Scene/TextureNames.h"

namespace rt::scene {

namespace {

void gatherSurfaces(const ObjectDesc& object, const ObjectPath& path, std::vector<ObjectPath>& surfaces) {
    if (const auto* group = std::get_if<GroupDesc>(&object.shape)) {
        for (std::size_t i = 0; i < group->objects.size(); ++i)
            gatherSurfaces(group->objects[i], path.child(i), surfaces);
    } else if (materialNameOf(object) != nullptr) {
        surfaces.push_back(path);
    }
}

} // namespace

std::vector<ObjectPath> surfacesOf(const SceneDesc& scene, const ObjectPath& path) {
    std::vector<ObjectPath> surfaces;
    if (const ObjectDesc* object = findObject(scene, path)) gatherSurfaces(*object, path, surfaces);
    return surfaces;
}

template <typename Value>
std::pair<std::string, bool> MaterialTransfer::Section<Value>::place(const std::string& like, const Value& value) {
    if (const auto same = there.find(like); same != there.end() && same->second == value) return {like, false};
    for (const auto* section : {&there, static_cast<const std::map<std::string, Value>*>(&added)})
        for (const auto& [name, other] : *section)
            if (other == value) return {name, false};
    const auto isTaken = [&](const std::string& name) { return there.contains(name) || added.contains(name); };
    const std::string name = freeName(like, isTaken);
    added[name] = value;
    return {name, true};
}

std::string MaterialTransfer::bringTexture(const std::string& name) {
    if (const auto brought = broughtTextures_.find(name); brought != broughtTextures_.end()) return brought->second;
    broughtTextures_[name] = name; // textures that contain themselves end here, and are refused later
    const auto found = source_.textures.find(name);
    if (found == source_.textures.end()) return name;
    TextureDesc texture = found->second;
    forEachInnerTexture(texture, [&](std::string& inner) { inner = bringTexture(inner); });
    const auto [own, isNew] = textures_.place(name, texture);
    if (isNew) edits_.emplace_back(SetTexture{own, texture});
    return broughtTextures_[name] = own;
}

std::string MaterialTransfer::bring(const std::string& name) {
    MaterialDesc material = source_.materials.at(name);
    forEachTextureName(material, [&](std::string& texture) { texture = bringTexture(texture); });
    const auto [own, isNew] = materials_.place(name, material);
    if (isNew) edits_.emplace_back(SetMaterial{own, material});
    return own;
}

bool MaterialTransfer::assign(std::span<const ObjectPath> objects, const std::string& material) {
    bool hasAny = false;
    for (const ObjectPath& object : objects)
        for (const ObjectPath& surface : surfacesOf(scene_, object)) {
            hasAny = true;
            if (*materialNameOf(*findObject(scene_, surface)) != material)
                edits_.emplace_back(SetMaterialOf{surface, material});
        }
    return hasAny;
}

} // namespace rt::scene
