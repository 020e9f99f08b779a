// What of geometry kernels can work with, in single precision.
#pragma once
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "Common/Shared/Base/Shim.h"

namespace rt::scene {

// Fourth powers of lengths stay finite and normal in float; what lies outside counts as degenerate.
constexpr double kMaxCoordinate = 4e9;
constexpr double kMinArea = 1e-18;

inline bool representable(const glm::dvec3& v) {
    return std::abs(v.x) <= kMaxCoordinate && std::abs(v.y) <= kMaxCoordinate && std::abs(v.z) <= kMaxCoordinate;
}

// Twice the vector area of the triangle of vertices as kernels see them; zero when there is none.
inline glm::dvec3 doubleArea(const shared::vec3& a, const shared::vec3& b, const shared::vec3& c) {
    const glm::dvec3 normal = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
    const bool usable = representable(a) && representable(b) && representable(c) && glm::length(normal) >= 2 * kMinArea;
    return usable ? normal : glm::dvec3(0);
}

} // namespace rt::scene
