// Edits as text, for files that outlive the program.
#pragma once
#include <string>

#include "Common/Scene/Edit/SceneEdit.h"
#include "Common/Scene/Json/JsonNode.h"

namespace rt::scene {

// One line of JSON, of what a scene file can hold. Throws InputError where that cannot.
std::string toText(const SceneEdit& edit);
// Gives back an equal edit; files that it names must be where they were. Of a model that is added what its file names
// must lie below the folder, as --assets-below says; empty: anywhere. Throws InputError.
SceneEdit parseEdit(const JsonNode& node, const std::string& assetsBelow = {});

} // namespace rt::scene
