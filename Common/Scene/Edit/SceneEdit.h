// The smallest changes of a scene. Each keeps only what it replaces: applied, it holds what was there before and is its
// own reverse.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "Common/Scene/AddedModels.h"
#include "Common/Scene/Edit/ObjectPath.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

struct SetObject {
    ObjectPath path;
    ObjectDesc object;
};
// Without touching what may be large: a mesh, what is in a group.
struct SetTransform {
    ObjectPath path; // of a group or an instance
    Transform transform;
};
struct SetMaterialOf {
    ObjectPath path;
    std::string material;
};
struct SetHidden {
    ObjectPath path;
    bool isHidden = false;
};
// With an object: inserts it, and what stood there goes behind it. Without: removes what stands there.
struct PlaceObject {
    ObjectPath path;
    std::optional<ObjectDesc> object;
};
// With a transform: puts the object into a group of its own, which takes its place. Without: the reverse.
struct WrapObject {
    ObjectPath path;
    std::optional<Transform> transform;
    bool isHidden = false; // the group
};
// What has a name in the scene; without a value: it is removed.
struct SetMaterial {
    std::string name;
    std::optional<MaterialDesc> value;
};
struct SetTexture {
    std::string name;
    std::optional<TextureDesc> value;
};
struct SetPrototype {
    std::string name;
    std::optional<std::vector<ObjectDesc>> value;
};
// With a model: the scene takes it in, with what it brings. Without: the reverse, of whatever names are the model's.
struct SetModel {
    std::string name;
    std::optional<ModelDesc> value;
    ModelContents contents; // with a model
};
struct SetCamera {
    CameraDesc value;
};
struct SetBackground {
    Background value;
};
struct SetRenderDefaults {
    RenderDefaults value;
};
struct SetTargets {
    std::vector<TargetDesc> value;
};
struct SetTitle {
    std::string value;
};
using SceneEdit =
    std::variant<SetObject, SetTransform, SetMaterialOf, SetHidden, PlaceObject, WrapObject, SetMaterial, SetTexture,
                 SetPrototype, SetCamera, SetBackground, SetRenderDefaults, SetTargets, SetTitle, SetModel>;

// Applies it; afterwards it is what undoes it. It must be valid, see EditCheck.h.
void exchange(SceneDesc& scene, SceneEdit& edit);

// Whether which objects there are, and in which order, depends on it.
bool changesStructure(const SceneEdit& edit);

// Where an object stands after an edit that has not been applied yet; nothing where that removes it.
std::optional<ObjectPath> placeAfter(const SceneEdit& edit, ObjectPath path);

// Whether the later one replaces what the earlier one has set, so that the earlier one undoes both.
bool replaces(const SceneEdit& later, const SceneEdit& earlier);

std::size_t bytesOf(const SceneEdit& edit); // of memory
std::size_t bytesOf(const ObjectDesc& object);

} // namespace rt::scene
