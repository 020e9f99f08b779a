// Moving, turning and scaling objects of any kind.
#pragma once
#include <optional>
#include <vector>

#include "Common/Scene/Compiler/Bounds.h"
#include "Common/Scene/Edit/SceneEdit.h"

namespace rt::scene {

// What an object becomes under an affine map of the space that it is described in, where its own numbers can say it: a
// sphere of any map that scales uniformly, a quad of any. Lights without extent keep what they emit. Nothing where they
// cannot, or where the object is large: then a group around it can.
std::optional<ObjectDesc> mapped(const ObjectDesc& object, const Affine& map);

// The edit that takes an object through the steps, which are of the scene's space, whatever groups it is in: by its own
// numbers, by its transform, or by a group around it. The object must exist, and so must the inverse of the groups'
// transforms.
SceneEdit moved(const SceneDesc& scene, const ObjectPath& path, const Transform& steps);

// About a point that stays where it is.
Transform turned(const glm::dvec3& pivot, const glm::dvec3& axis, double degrees);
// Along the scene's axes, or along others that are at right angles and of length 1.
Transform scaled(const glm::dvec3& pivot, const glm::dvec3& factors, const glm::dmat3& axes = glm::dmat3(1.0));

// An object's own axes, of length 1 and at right angles, in the scene's space: as the groups around it and its own
// transform turn them; of what has a direction, Z; of a quad, its normal.
glm::dmat3 localAxes(const SceneDesc& scene, const ObjectPath& path);

// Where a light without extent stands, in the scene's space; nothing for other objects, and for directional lights.
std::optional<glm::dvec3> lightPosition(const SceneDesc& scene, const ObjectPath& path);
// Of a medium, likewise; empty for other objects.
Bounds mediumBounds(const SceneDesc& scene, const ObjectPath& path);

// Copies of the objects, whose paths are sorted and none within another, each put behind what it is of. `copies`: where
// they are afterwards.
std::vector<SceneEdit> duplicated(const SceneDesc& scene, const std::vector<ObjectPath>& paths,
                                  std::vector<ObjectPath>& copies);
// Without the objects, likewise.
std::vector<SceneEdit> removed(const std::vector<ObjectPath>& paths);

} // namespace rt::scene
