#pragma once
#include <cstdint>

#include "Common/Scene/CompiledScene.h"

namespace rt::scene {

// Of every array and of the globals: two scenes with one hash render to the same image under equal camera and settings.
std::uint64_t sceneHash(const CompiledScene& scene);

} // namespace rt::scene
