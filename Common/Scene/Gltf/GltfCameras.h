// Cameras of a glTF file as those of a scene.
#pragma once
#include "Common/Scene/Compiler/Bounds.h"
#include "Common/Scene/Gltf/GltfFile.h"
#include "Common/Scene/Gltf/GltfNodes.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// Adds all that nodes have; the first is the scene's view. Without one all within `bounds` is seen from the front.
// Throws InputError naming file and place.
void addCameras(const GltfFile& file, const GltfNodes& nodes, const Bounds& bounds, SceneDesc& scene);

} // namespace rt::scene
