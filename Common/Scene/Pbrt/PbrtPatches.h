// Vertices of pbrt's meshes, and bilinear patches as quads and triangles.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "Common/Scene/Pbrt/PbrtParameters.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// P, N and uv (st) of a mesh. Throws InputError, also where there are not as many of each.
template <class Real>
MeshOf<Real> pbrtVertices(const PbrtParameters& parameters);
// Of `corners` a face, each below `vertices`; without any, of one face.
std::vector<std::uint32_t> pbrtIndices(const PbrtParameters& parameters, std::size_t vertices, std::size_t corners);

// Patches have their vertices in the order (0,0), (1,0), (0,1), (1,1) of u and v.
// One that is a parallelogram, with u and v as its texture coordinates, as a quad with the same front.
std::optional<QuadDesc> pbrtQuad(const MeshData& vertices, const std::vector<std::uint32_t>& indices);
// How many triangles pbrtPatches() makes; whether some patch is not flat.
std::size_t pbrtPatchTriangles(const MeshData& vertices, const std::vector<std::uint32_t>& indices, bool& isBent);
MeshData pbrtPatches(const MeshData& vertices, const std::vector<std::uint32_t>& indices);

} // namespace rt::scene
