// Whether a parameter of a material has one value everywhere.
#pragma once
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

inline bool isAlways(const NumberOrTexture& number, double value) {
    return number.texture.empty() && number.factor == value;
}
inline bool isAlways(const ColorOrTexture& color, double value) {
    const auto* constant = std::get_if<glm::dvec3>(&color);
    return constant != nullptr && *constant == glm::dvec3(value);
}

} // namespace rt::scene
