// Scenes of glTF 2.0, read by tinygltf: docs/gltf.md says what becomes of what.
#pragma once
#include <filesystem>

#include "Common/Scene/Moment.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// A .gltf or .glb file as a scene: its default scene, posed as an animation has it, without other light than its own,
// seen by its first camera, or from the front where there is none. Images stay where they are, named by ImageTexture.
// What is left out gets a notice. Throws InputError in one line, naming the file and its JSON path, and UsageError for
// an animation that there is not.
SceneDesc loadGltfScene(const std::filesystem::path& path, const Moment& moment = {});

} // namespace rt::scene
