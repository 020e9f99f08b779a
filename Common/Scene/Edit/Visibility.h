// Hiding objects, and showing them again.
#pragma once
#include <vector>

#include "Common/Scene/Edit/SceneEdit.h"

namespace rt::scene {

bool isShown(const SceneDesc& scene, const ObjectPath& path); // neither it nor a group around it is hidden

// Edits of those objects alone that are not yet as wanted.
std::vector<SceneEdit> hidden(const SceneDesc& scene, const std::vector<ObjectPath>& paths, bool isHidden);
// Of all of the scene's own lists that are hidden; instances show what their prototypes do.
std::vector<SceneEdit> allShown(const SceneDesc& scene);
// The objects alone, whose paths are sorted, and what gives light, without which they would be dark: it stays as it is.
std::vector<SceneEdit> soloed(const SceneDesc& scene, const std::vector<ObjectPath>& paths);

// Whether it, or something in it, gives off light. Of meshes from files that bring their own materials it is not known:
// they count as none.
bool givesLight(const SceneDesc& scene, const ObjectDesc& object);

} // namespace rt::scene
