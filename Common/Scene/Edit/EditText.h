// Edits as text, for files that outlive the program.
#pragma once
#include <string>

#include "Common/Scene/Edit/SceneEdit.h"
#include "Common/Scene/Json/JsonNode.h"

namespace rt::scene {

// One line of JSON, of what a scene file can hold. Throws InputError where that cannot.
std::string toText(const SceneEdit& edit);
// Gives back an equal edit; files that it names must be where they were. Throws InputError.
SceneEdit parseEdit(const JsonNode& node);

} // namespace rt::scene
