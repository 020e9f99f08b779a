// What shared::Sphere::power is of a sphere as it was authored, before its numbers are rounded.
#pragma once
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "Common/Shared/Shape/Shapes.h"

namespace rt::scene {

// From sums and differences of lengths, so that a sphere of 10^9 that touches the origin keeps the digits of that.
inline float spherePower(const glm::dvec3& center, double radius) {
    const double distance = glm::length(center);
    const auto power = static_cast<float>((distance - radius) * (distance + radius));
    return shared::isNearSphere(power, static_cast<float>(radius)) ? power : shared::kInfinity;
}

} // namespace rt::scene
