// Sun and sky as the sky image that kernels have.
#pragma once
#include <cstdint>

#include "Common/Scene/CompiledScene.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// Appends the latitude-longitude image of the sky, its sun in the middle column, and gives its index; the sky's factor
// and azimuth are left to who shows it. A texel that the sun's edge crosses has the share of the radiance that it
// covers of it: all of them together, above the horizon and below, give the sun's irradiance. Below the horizon there
// is what a diffuse ground reflects of it all.
std::uint32_t appendSunSkyMap(const SunSkyBackground& sky, CompiledScene& out);
// By which the image is turned about +Y, in degrees.
inline double sunSkyRotation(const SunSkyBackground& sky) {
    return 90 - sky.sunAzimuth;
}

} // namespace rt::scene
