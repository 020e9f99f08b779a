// What a pixel shows, for people who ask.
#pragma once
#include <cstdint>
#include <optional>

#include <glm/vec2.hpp>

#include "Common/Scene/CompiledScene.h"

namespace rt::app {

struct VisibleSurface {
    std::uint32_t material; // its index
    std::uint32_t object;   // that it comes from, as scene::Origins counts
};

// The surface that the ray through the middle of a pixel and of the lens meets first, halfway through the
// shutter's time, whether opaque or not; nothing where it meets none. Without a tree, as one ray is not worth building
// it: of boxes around geometries that instances share, then of all that is in them. Nothing as well where that would
// take longer than a frame of a window.
std::optional<VisibleSurface> visibleSurface(const scene::CompiledScene& scene, const scene::CameraDesc& camera,
                                             const glm::uvec2& size, const glm::uvec2& pixel);

} // namespace rt::app
