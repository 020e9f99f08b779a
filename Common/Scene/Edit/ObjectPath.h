// Which object of a scene: where it stands. A path stays that of its object until something before it in the same list
// is added or removed, and the history of edits is walked through in order, so that what it says holds whenever it is
// read.
#pragma once
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "Common/Scene/Affine.h"
#include "Common/Scene/Origins.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

struct ObjectPath {
    std::string prototype;              // of which; empty: among the scene's own objects
    std::vector<std::uint32_t> indices; // in its list, then in those of the groups that it leads through; never empty

    auto operator<=>(const ObjectPath&) const = default; // NOLINT(modernize-use-nullptr): `<=> 0` has no pointer
    ObjectPath child(std::size_t index) const;           // of a group
    bool isWithin(const ObjectPath& group) const;        // not the group itself
};

std::string textOf(const ObjectPath& path); // as the JSON path of a scene file: "/objects/3/objects/1"

// Null where there is no such object.
const ObjectDesc* findObject(const SceneDesc& scene, const ObjectPath& path);
ObjectDesc* findObject(SceneDesc& scene, const ObjectPath& path);
// The list that the object stands in or may be inserted into; null where there is none.
std::vector<ObjectDesc>* listOf(SceneDesc& scene, const ObjectPath& path);

// The transforms of the groups around the object, from its own space to that of the scene or its prototype.
Affine groupTransform(const SceneDesc& scene, const ObjectPath& path);

// Objects that are no groups, counted depth first through the scene's own lists: what CompiledScene::origins counts.
// Nothing for an object of a prototype, or where there is none.
ObjectPath pathOfLeaf(const SceneDesc& scene, std::uint32_t leaf); // without indices where there are not so many
// For each of the objects, whose paths are sorted and none within another: of a group, all that are in it; of a
// prototype's object, and where there is none, no leaves.
std::vector<ObjectRange> leavesOf(const SceneDesc& scene, std::span<const ObjectPath> paths);

// The name of the material of its surface; null for objects that have none of their own.
const std::string* materialNameOf(const ObjectDesc& object);
std::string* materialNameOf(ObjectDesc& object);
// Of a group or an instance; null for others.
const Transform* transformOf(const ObjectDesc& object);
Transform* transformOf(ObjectDesc& object);

} // namespace rt::scene
