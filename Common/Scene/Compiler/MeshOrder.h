#pragma once
#include <vector>

#include <glm/vec3.hpp>

namespace rt::scene {

// Reorders triangles (indices into positions) along the Morton curve of their middles, equal codes in their old order:
// neighbours in memory become neighbours in space.
void orderAlongCurve(const std::vector<glm::vec3>& positions, std::vector<glm::uvec3>& triangles);

} // namespace rt::scene
