// Scenes as files of glTF 2.0: docs/gltf-export.md says what becomes of what.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "Common/Scene/Gltf/GltfTextureWriter.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// Writes a scene as a .glb file, or as .gltf with its buffer and images beside; what is there is replaced when all has
// been read. Spheres and other shapes become triangles, materials of all kinds the nearest that glTF has. Hidden
// objects, prototypes without instances and materials that nothing has are no part of it. Returns what was left out or
// changed, one line each. Throws RenderError for files that cannot be written, InputError for images and models that
// cannot be read, materials that are not defined, and instances without end.
std::vector<std::string> writeGltf(const SceneDesc& scene, const std::filesystem::path& file,
                                   const GltfImageTools& tools = {});

} // namespace rt::scene
