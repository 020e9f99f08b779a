// The triangles of glTF's primitives.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "Common/Scene/Gltf/GltfFile.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// Corners of its triangles, before any is read; 0 for points and lines.
std::uint64_t cornerCount(const GltfFile& file, const tinygltf::Primitive& primitive);

// A primitive of triangles, strips or fans, with what its material uses of it. Texture coordinates run upwards, as
// everywhere else here. Without normals it is faceted. With `tangentSet`, tangents of that set of texture coordinates
// are computed where the file has none: MikkTSpace's weighting by angles; a vertex between mirrored parts is split.
// `isOpaque`: vertex colours have no opacity. Throws InputError naming `place`.
MeshData readPrimitive(const GltfFile& file, const tinygltf::Primitive& primitive, bool isOpaque,
                       std::optional<std::uint32_t> tangentSet, const std::string& place);

} // namespace rt::scene
