// Tangents, which maps of normals refer to.
#pragma once
#include <cstdint>

#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// Gives a mesh the tangents of its first or second (`set` 1) texture coordinates, which it must have: the direction of
// growing u, summed over the triangles at a vertex by the angle there, apart for each orientation of the texture
// (M. Mikkelsen, Simulation of Wrinkled Surfaces Revisited, 2008, as his MikkTSpace does). A vertex between mirrored
// parts is split, and without normals each corner becomes a vertex of its own.
void addTangents(MeshData& mesh, std::uint32_t set);

} // namespace rt::scene
