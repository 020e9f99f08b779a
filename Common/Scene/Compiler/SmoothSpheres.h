#pragma once
#include "Common/Scene/CompiledScene.h"

namespace rt::scene {

// The spheres of clear glass that lights may be connected to through, those that most light falls on first, and how
// they see the lights, which are complete. None where there are more lights than kContributionLights.
void findSmoothSpheres(CompiledScene& out);

} // namespace rt::scene
