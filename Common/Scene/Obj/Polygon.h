#pragma once
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace rt::scene {

inline constexpr std::size_t kMaxPolygonCorners = 4096;

// Cuts a simple polygon of 3 to kMaxPolygonCorners corners into corners.size() - 2 triangles of its winding, as indices
// into `corners`. It may be concave and slightly bent; one that intersects itself or has no area is cut into a fan.
std::vector<glm::uvec3> cutPolygon(const std::vector<glm::dvec3>& corners);

} // namespace rt::scene
