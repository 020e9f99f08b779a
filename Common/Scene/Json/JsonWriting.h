// Values as scene files have them.
#pragma once
#include <string>
#include <type_traits>
#include <variant>

#include <glm/vec3.hpp>

#include "Common/Scene/Json/SceneWriter.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

inline OrderedJson json(const glm::dvec3& v) {
    return OrderedJson::array({v.x, v.y, v.z});
}

inline OrderedJson json(const ColorOrTexture& source) {
    if (const auto* color = std::get_if<glm::dvec3>(&source)) return json(*color);
    return std::get<std::string>(source);
}

// Leaves out what is usual.
template <typename Value>
void setUnless(OrderedJson& target, const char* key, const Value& value, const Value& usual) {
    if (value == usual) return;
    if constexpr (std::is_same_v<Value, glm::dvec3> || std::is_same_v<Value, ColorOrTexture>)
        target[key] = json(value);
    else
        target[key] = value;
}

} // namespace rt::scene
