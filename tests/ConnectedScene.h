// A scene whose lights are connected to through every sphere of glass that can be, also where the scene compiler thinks
// that it is not worth it.
#pragma once
#include <memory>

#include "Common/Scene/Compiler/SpecularCasters.h"

namespace rt::test {

inline std::shared_ptr<const scene::CompiledScene> connectedThroughAll(const scene::CompiledScene& scene) {
    const auto connected = std::make_shared<scene::CompiledScene>(scene);
    scene::findSpecularCasters(*connected, 0);
    return connected;
}

} // namespace rt::test
