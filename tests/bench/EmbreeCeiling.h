// What this machine's processor can do with rays alone, by a library made for nothing else.
#pragma once
#include <optional>

#include "Common/Scene/CompiledScene.h"

namespace rt::bench {

// Rays per second of Embree 3 (robust mode, single-ray calls) on all threads, for this scene's geometry: rays of the
// camera and three cosine-distributed bounces of each, in the order of paths. Nothing for scenes with instances or
// moving spheres, and where the program was built without Embree. Takes a second or two.
std::optional<double> embreeRaysPerSecond(const scene::CompiledScene& scene);

} // namespace rt::bench
