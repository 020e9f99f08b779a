// Where blurred mirrors show lights in an image.
#pragma once
#include <cstdint>

#include "Common/Scene/LightEdges.h"

namespace rt::scene {

// Adds the pixels in which a quad of metal with little fuzz shows a light as a small and bright spot, too small to be
// the same for all of a pixel's samples. What is in between is not looked at. None of many lights or quads. The camera
// is that of an image of this size, its lens a point; `edges` has the image's parts.
void addLightsInMirrors(const CompiledScene& scene, const shared::Camera& camera, std::uint32_t width,
                        std::uint32_t height, LightEdges& edges);

} // namespace rt::scene
