// Flat surfaces that are huge beside how near they pass to the origin of coordinates, which is where the camera was at
// first: the ground, mostly.
#pragma once
#include <glm/vec3.hpp>

#include "Common/Scene/Affine.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// A triangle is huge if its longest edge is so many times its distance from the origin of coordinates. What rounding
// adds to a hit, and the offset of rays that leave it, grow with the extent (shared::extentError()): up to this ratio
// they are a hundred thousandth of that distance, and nothing is gained by pieces.
constexpr double kHugeRatio = 64;

bool isHuge(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

// The mesh with its huge triangles divided, the smaller the nearer they are to the origin of the space that `map` leads
// to: errors then grow with distance and not with extent. Triangles that share an edge still share all of it.
// `showsImage`: the pieces have to know which part of the image is theirs.
MeshData divideHugeTriangles(const MeshData& mesh, const Affine& map, bool showsImage);

} // namespace rt::scene
