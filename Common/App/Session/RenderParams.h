#pragma once
#include <cstdint>
#include <string>

#include "Common/App/Session/Settings.h"
#include "Common/Scene/CompiledScene.h"
#include "Common/Shared/Base/Types.h"

namespace rt::app {

// The settings as kernels see them for this scene.
shared::RenderParams makeRenderParams(const scene::CompiledScene& scene, const RenderSettings& settings);

// What a kernel needs for this scene, camera and settings, and whatever else the settings force on it.
std::uint32_t renderFeatures(const scene::CompiledScene& scene, const scene::CameraDesc& camera,
                             const RenderSettings& settings);

// How each shape of light that exists is sampled, strategies of `auto` named: "sphere: cone, quad: auto (area, strip,
// ...)".
std::string describeLightShapes(const RenderSettings& settings, std::uint32_t features);

} // namespace rt::app
