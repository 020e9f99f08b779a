// Whether an edit may be made.
#pragma once
#include "Common/Scene/Edit/SceneEdit.h"

namespace rt::scene {

// Throws InputError, one sentence with the place, where the edit names what is not there, removes what is in use, or
// sets what a scene file could not hold: what passes can be written and read back.
void checkEdit(const SceneDesc& scene, const SceneEdit& edit);

// How many surfaces have the material, those of prototypes once.
std::size_t materialUses(const SceneDesc& scene, const std::string& name);
// How often materials, other textures and media refer to the texture.
std::size_t textureUses(const SceneDesc& scene, const std::string& name);
// How many meshes that name the material show no map of directions, as normals are, for want of tangents.
std::size_t meshesWithoutTangents(const SceneDesc& scene, const std::string& material);

} // namespace rt::scene
