// The parser of glTF's JSON, without what it would do by itself: it decodes no image and opens no file.
#pragma once
#if defined(__GNUC__)
#pragma GCC system_header
#endif
#include <fstream> // which it leaves out without file access, though its writers use it

#include <nlohmann/json.hpp>

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_JSON
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#define TINYGLTF_USE_CPP14
#include <tiny_gltf.h>
