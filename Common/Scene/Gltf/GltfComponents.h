// Component types of accessors.
#pragma once
#include <cstdint>

#include "Common/Scene/Gltf/TinyGltf.h"

namespace rt::scene {

template <typename Function> // (value of the component type)
auto withComponentType(int type, const Function& function) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return function(std::int8_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return function(std::uint8_t{});
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return function(std::int16_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return function(std::uint16_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return function(std::uint32_t{});
        default:
            return function(float{});
    }
}

} // namespace rt::scene
