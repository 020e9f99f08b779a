// Scene files. The format is published as Assets/scene.schema.json.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "Common/Scene/Moment.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// Reads a scene file; files it names are looked for beside it, then among the assets. Throws InputError: for syntax
// with line and column, for contents with the JSON path, the value and what is allowed.
SceneDesc loadSceneFile(const std::filesystem::path& path);

// The same from a text; `file` stands in messages, `folder` is where files are looked for first.
SceneDesc parseScene(std::string_view text, const std::string& file, const std::filesystem::path& folder);

// The text of a scene file. parseScene gives back an equal description, but for its id, and numbers to the last bit.
std::string toJson(const SceneDesc& scene);

// A model that a scene file begins with, and changes: the file is named, not copied.
struct ImportDesc {
    std::filesystem::path file; // whole, or as it is to be written
    Moment moment;
};
std::optional<ImportDesc> importOf(const std::filesystem::path& sceneFile); // none: the file has all by itself
// The text of a scene file of what the scene has beyond the model, as loadModelFile() gives it. Throws InputError where
// reading it would not give an equal description.
std::string toJson(const SceneDesc& scene, const ImportDesc& import, SceneDesc model);

} // namespace rt::scene
