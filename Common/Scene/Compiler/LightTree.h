// The tree by which one of many lights is chosen (Common/Shared/LightTree.h descends it).
#pragma once
#include "Common/Scene/CompiledScene.h"

namespace rt::scene {

// Fills lightNodes and lightToLeaf from the lights proper and their bounds if there are more than `contribution` weighs
// one by one. Lights without intensity are left out. Deterministic.
void buildLightTree(CompiledScene& out);

} // namespace rt::scene
