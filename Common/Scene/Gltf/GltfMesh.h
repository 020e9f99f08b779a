// The triangles of glTF's primitives.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "Common/Scene/Affine.h"
#include "Common/Scene/Gltf/GltfFile.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// How a primitive is read.
struct PrimitiveUse {
    bool isOpaque = true;                    // vertex colours have no opacity
    std::optional<std::uint32_t> tangentSet; // of the texture coordinates that tangents are computed of
    bool isStretched = false;                // tangents matter without texture coordinates, too
    std::span<const double> weights;         // of morph targets; of further ones 0
    std::span<const Affine> joints;          // that move its vertices; empty: it has no skin
};

bool isTriangles(const tinygltf::Primitive& primitive); // not points or lines

// Corners of its triangles and vertices that pose them, before any is read; 0 for points and lines.
std::uint64_t elementCount(const GltfFile& file, const tinygltf::Primitive& primitive, const PrimitiveUse& use);

// A primitive of triangles, strips or fans, with what its material uses of it, in its pose. Texture coordinates run
// upwards, as everywhere else here. Without normals it is faceted. With `tangentSet`, tangents of that set of texture
// coordinates are computed where the file has none: MikkTSpace's weighting by angles; a vertex between mirrored parts
// is split. `rescaled`: how many vertices have weights of joints that do not sum up to 1. Throws InputError naming
// `place`.
MeshData readPrimitive(const GltfFile& file, const tinygltf::Primitive& primitive, const PrimitiveUse& use,
                       const std::string& place, std::size_t& rescaled);

} // namespace rt::scene
