#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

namespace rt::scene {

// Triangles, as indices into positions, with their winding turned over where `mirrors`.
struct WoundTriangles {
    const std::vector<glm::uvec3>& all;
    bool mirrors = false;

    glm::uvec3 operator[](std::uint32_t i) const {
        glm::uvec3 t = all[i];
        if (mirrors) std::swap(t.y, t.z);
        return t;
    }
};

// Sorts `order`, numbers of triangles, along the Morton curve of their middles, equal codes in their old order:
// neighbours in memory become neighbours in space.
void orderAlongCurve(const std::vector<glm::vec3>& positions, const WoundTriangles& triangles,
                     std::vector<std::uint32_t>& order);

} // namespace rt::scene
