#include "Common/Scene/Pbrt/PbrtMaps.h"

#include <optional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

namespace rt::scene {

Affine pbrtMap(const PbrtDirective& d) {
    const std::vector<double>& n = d.numbers;
    switch (d.keyword) {
        case PbrtKeyword::Translate:
            return translation({n[0], n[1], n[2]});
        case PbrtKeyword::Scale:
            return scaling({n[0], n[1], n[2]});
        case PbrtKeyword::Rotate:
            if (n[1] == 0 && n[2] == 0 && n[3] == 0) d.place.fail("Rotate: its axis must not be 0");
            return toAffine({Rotate{{n[1], n[2], n[3]}, n[0]}});
        case PbrtKeyword::LookAt: {
            const glm::dvec3 eye(n[0], n[1], n[2]), forward = glm::dvec3(n[3], n[4], n[5]) - eye;
            const glm::dvec3 right = glm::cross(glm::dvec3(n[6], n[7], n[8]), forward);
            if (!(glm::length(right) > 0))
                d.place.fail("LookAt: eye and point must differ, and up must not be 0 or parallel to the view");
            const glm::dvec3 z = glm::normalize(forward), x = glm::normalize(right);
            const std::optional<Affine> toCamera = inverse(Affine{glm::dmat3(x, glm::cross(z, x), z), eye});
            if (!toCamera) d.place.fail("LookAt: its numbers are too large");
            return *toCamera;
        }
        default: // 16 numbers, column after column
            break;
    }
    if (n[15] != 1) d.place.fail(std::string(d.name) + ": its last number must be 1");
    return {glm::dmat3(n[0], n[1], n[2], n[4], n[5], n[6], n[8], n[9], n[10]), {n[12], n[13], n[14]}};
}

bool hasPerspective(const PbrtDirective& d) {
    return d.numbers.size() == 16 && (d.numbers[3] != 0 || d.numbers[7] != 0 || d.numbers[11] != 0);
}

} // namespace rt::scene
