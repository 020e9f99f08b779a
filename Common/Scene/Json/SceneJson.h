// Scene files. The format is published as Assets/scene.schema.json.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// Reads a scene file; files it names are looked for beside it, then among the assets. Throws InputError: for syntax
// with line and column, for contents with the JSON path, the value and what is allowed.
SceneDesc loadSceneFile(const std::filesystem::path& path);

// The same from a text; `file` stands in messages, `folder` is where files are looked for first.
SceneDesc parseScene(std::string_view text, const std::string& file, const std::filesystem::path& folder);

// The text of a scene file. parseScene gives back an equal description, but for its id, and numbers to the last bit.
std::string toJson(const SceneDesc& scene);

} // namespace rt::scene
