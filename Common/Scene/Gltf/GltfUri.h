// URIs of glTF files, after RFC 3986 and, for data within, RFC 2397.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "Common/Scene/Json/JsonNode.h"

namespace rt::scene {

bool isDataUri(std::string_view uri);

// What a data URI holds, of any media type. Throws InputError naming file and place.
std::vector<std::byte> bytesOfDataUri(const JsonNode& uri);

// The file that a URI beside `path` names, without query and fragment unless there is one of the whole name; throws
// InputError for what is no relative path.
std::filesystem::path besideGltf(const std::filesystem::path& path, const std::string& uri);

} // namespace rt::scene
