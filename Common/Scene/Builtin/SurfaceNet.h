#pragma once
#include <functional>

#include <glm/vec3.hpp>

#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// The zero surface of `field` (negative inside) as a closed mesh with normals: one vertex in each cube of edge `cell`
// that the surface crosses, at the mean of its crossings of the cube's edges (Gibson's surface nets). The surface must
// lie inside [lower, upper]. `field` must not change faster than 1.25 times a distance: where it is large nothing is
// looked for.
MeshData surfaceNet(const std::function<double(const glm::dvec3&)>& field, const glm::dvec3& lower,
                    const glm::dvec3& upper, double cell);

} // namespace rt::scene
