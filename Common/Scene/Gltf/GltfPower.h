// Radiances and intensities of any size as colours that end at 1 and a strength.
#pragma once
#include <algorithm>
#include <cmath>

#include <glm/vec3.hpp>

namespace rt::scene {

struct GltfPower {
    glm::dvec3 color{1};
    double strength = 0;
};

// Whose product is `power`, to the last bit; the strength is at least `least`.
inline GltfPower toPower(const glm::dvec3& power, double least) {
    const double largest = std::max({power.x, power.y, power.z, least});
    if (!(largest > 0)) return {};
    GltfPower result{power / largest, largest};
    if (result.color * largest == power) return result;
    const double rounded = std::exp2(std::ceil(std::log2(largest)));
    return {power / rounded, rounded};
}

} // namespace rt::scene
