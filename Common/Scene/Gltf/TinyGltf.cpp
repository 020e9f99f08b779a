// tinygltf, compiled here and nowhere else: Debian's shared library would decode images by a second stb, and vcpkg has
// the header only.
#define TINYGLTF_IMPLEMENTATION
#include "Common/Scene/Gltf/TinyGltf.h"
