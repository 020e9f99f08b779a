// Values of extensions and of counts, as materials and messages need them.
#pragma once
#include <cstdint>
#include <string>

#include <glm/vec3.hpp>

#include "Common/Scene/Gltf/TinyGltf.h"

namespace rt::scene {

// Null where there is none.
const tinygltf::Value* member(const tinygltf::Value& object, const char* key);
const tinygltf::Value* extension(const tinygltf::ExtensionMap& extensions, const char* name);

// `usual` where there is none.
double numberOf(const tinygltf::Value& object, const char* key, double usual);
double component(const tinygltf::Value& object, const char* key, int index, double usual);
glm::dvec3 vectorOf(const tinygltf::Value& object, const char* key, double usual);

} // namespace rt::scene
