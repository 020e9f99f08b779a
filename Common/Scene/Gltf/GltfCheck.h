// What makes the JSON of a glTF file safe to follow.
#pragma once
#include <string>
#include <vector>

#include "Common/Scene/Json/JsonNode.h"

namespace rt::scene {

// Checks version, required extensions, that every index names an element that exists, and that buffer views and
// accessors lie within their buffers by the lengths that the file states. Throws InputError naming file and JSON path.
// Returns a notice for each extension that the file uses and this program leaves out.
std::vector<std::string> checkGltf(const JsonNode& root);

} // namespace rt::scene
