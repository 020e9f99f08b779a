// Cameras of a glTF file as those of a scene.
#pragma once
#include <map>
#include <string>

#include "Common/Scene/Compiler/Bounds.h"
#include "Common/Scene/Gltf/GltfFile.h"
#include "Common/Scene/Gltf/GltfNodes.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// What stays while a file's animation moves it.
struct GltfStart {
    Bounds bounds; // of everything, in world space
    std::map<std::string, CameraDesc> cameras;
};

// Adds all that nodes have; the first is the scene's view. Without one all within the bounds is seen from the front.
// One whose node has no direction, as at a scale of 0, stays where it was at the start, or is left out; either with a
// notice. Throws InputError naming file and place.
void addCameras(const GltfFile& file, const GltfNodes& nodes, const GltfStart& start, SceneDesc& scene);

} // namespace rt::scene
