#pragma once
#include <cstdint>

#include "Common/Scene/CompiledScene.h"

namespace rt::scene {

// What the arrays of a finished scene need of a kernel.
shared::Features featureMask(const CompiledScene& scene);

} // namespace rt::scene
