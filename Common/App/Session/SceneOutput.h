// Scenes as files: by the ending, scene files or glTF.
#pragma once
#include <string>
#include <vector>

#include "Common/Scene/SceneDesc.h"

namespace rt::app {

// Whether scenes can be written to files of this ending. Names without any are those of scene files, and so is "-".
bool isSceneOutput(const std::string& file);
inline constexpr const char* kSceneOutputs = "a file whose name ends with .json, .glb or .gltf";

// .glb and .gltf: glTF. All else a scene file, "-" to standard output. Returns what was left out or changed, one line
// each. Throws RenderError where it cannot be written, and InputError for what the scene names and cannot be read.
std::vector<std::string> writeScene(const std::string& file, const scene::SceneDesc& scene);

} // namespace rt::app
