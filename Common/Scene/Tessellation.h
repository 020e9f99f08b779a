// Shapes as triangles, for files that know no others: with exact normals, and texture coordinates as shapes have them.
// Flat ones are exact; of round ones nothing is farther from the surface than a thousandth of the radius.
#pragma once
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

MeshData sphereMesh(); // about the origin, of radius 1
// Likewise, without texture coordinates, and the finer the nearer to a direction of unit length: at a distance d from
// there of less than 1 nothing is farther from the surface than d^2 / 1000, or 2e-8.
MeshData sphereMesh(const glm::dvec3& towards);

// Empty where they have no area.
MeshData meshOf(const QuadDesc& quad);
MeshData meshOf(const BoxDesc& box);
MeshData meshOf(const DiskDesc& disk);
MeshData meshOf(const CylinderDesc& cylinder);

} // namespace rt::scene
