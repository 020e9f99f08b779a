// Where spheres of glass and mirrors show lights in an image.
#pragma once
#include <cstdint>

#include "Common/Scene/Silhouettes.h"

namespace rt::scene {

// Adds the pixels that are noisy because a ray through them that a smooth sphere refracts or reflects, by chance, may
// meet a light or miss it; what is reflected inside a ball is not looked at. Found by rays on a grid, of two for the
// side of a pixel, fewer where spheres are large in the image: what is finer may be missed. None of many lights or
// spheres. The camera is that of an image of this size, its lens a point; `edges` has the image's parts.
void addLightsInSpheres(const CompiledScene& scene, const shared::Camera& camera, std::uint32_t width,
                        std::uint32_t height, Silhouettes& edges);

} // namespace rt::scene
