// MaterialX documents: docs/materials.md says what becomes of what.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// The materials of a .mtlx file with their textures, without objects. Images stay where they are. What is left out gets
// a notice. Throws InputError in one line, naming file, line, element, value and what is allowed.
SceneDesc loadMaterialX(const std::filesystem::path& path);

// The same from a text; `file` stands in messages, `folder` is where images are.
SceneDesc parseMaterialX(std::string_view text, const std::string& file, const std::filesystem::path& folder);

} // namespace rt::scene
