// Axis-aligned boxes.
#pragma once
#include <limits>

#include "Common/Shared/Base/Types.h"

namespace rt::accel {

struct Box {
    shared::vec3 lower{std::numeric_limits<float>::infinity()}; // empty until something is added
    shared::vec3 upper{-std::numeric_limits<float>::infinity()};

    void add(shared::vec3 point) {
        lower = shared::min(lower, point);
        upper = shared::max(upper, point);
    }
    void add(const Box& box) {
        lower = shared::min(lower, box.lower);
        upper = shared::max(upper, box.upper);
    }
    shared::vec3 size() const { return upper - lower; }
    // Half of the surface area; 0 for an empty box.
    float halfArea() const {
        const shared::vec3 s = size();
        return s.x < 0.0f ? 0.0f : s.x * s.y + s.y * s.z + s.z * s.x;
    }
};

} // namespace rt::accel
