#pragma once
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "Common/Scene/Affine.h"

namespace rt::scene {

// An axis-parallel box; empty until something is added.
struct Bounds {
    glm::dvec3 lower{std::numeric_limits<double>::infinity()};
    glm::dvec3 upper{-std::numeric_limits<double>::infinity()};

    bool empty() const { return !(lower.x <= upper.x); }
    glm::dvec3 center() const { return empty() ? glm::dvec3(0) : 0.5 * (lower + upper); }
    double radius() const { return empty() ? 0 : 0.5 * glm::length(upper - lower); }
    void add(const glm::dvec3& point) {
        lower = glm::min(lower, point);
        upper = glm::max(upper, point);
    }
    void add(const glm::dvec3& center, double radius) {
        add(center - radius);
        add(center + radius);
    }
    // The image of another box.
    void add(const Bounds& box, const Affine& map) {
        if (box.empty()) return;
        for (int corner = 0; corner < 8; ++corner)
            add(map.point({corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                           corner & 4 ? box.upper.z : box.lower.z}));
    }
};

} // namespace rt::scene
