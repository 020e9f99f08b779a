// The bright patches of a sky image that connections by way of smooth spheres lead to.
#pragma once
#include <vector>

#include "Common/Scene/CompiledScene.h"

namespace rt::scene {

struct BrightPatch {
    shared::SkyPatch texels{};
    shared::vec3 axis{};   // unit, to its middle, in the world
    double angle = 0;      // from there within which all of it is
    double irradiance = 0; // luminance, across the direction, of all that is in the patch
    double radiance = 0;   // luminance, mean by irradiance
};

struct BrightSky {
    std::vector<BrightPatch> patches; // apart from each other
    double irradiance = 0;            // as of a patch, of the whole sky
};

// Of the sky image that is among the lights; nothing where there is none. A patch is a rectangle around the brightest
// texel that is left, up to where it is dark on all sides.
BrightSky findBrightSky(const CompiledScene& scene);

} // namespace rt::scene
