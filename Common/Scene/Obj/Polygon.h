#pragma once
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace rt::scene {

// Cuts a simple polygon of at least 3 corners into corners.size() - 2 triangles of its winding, as indices into
// `corners`. It may be concave and slightly bent; one that intersects itself or has no area is cut somehow. Takes time
// in proportion to the corners, but for polygons as no program writes them.
std::vector<glm::uvec3> cutPolygon(const std::vector<glm::dvec3>& corners);

} // namespace rt::scene
