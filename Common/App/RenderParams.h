#pragma once
#include <cstdint>

#include "Common/App/Settings.h"
#include "Common/Scene/CompiledScene.h"
#include "Common/Shared/Types.h"

namespace rt::app {

// The settings as kernels see them.
shared::RenderParams makeRenderParams(const RenderSettings& settings);

// What a kernel needs for this scene, camera and settings, and whatever else the settings force on it.
std::uint32_t renderFeatures(const scene::CompiledScene& scene, const scene::CameraDesc& camera,
                             const RenderSettings& settings);

}  // namespace rt::app
