#pragma once
#include "Common/App/Settings.h"
#include "Common/Shared/Types.h"

namespace rt::app {

// The settings as kernels see them.
shared::RenderParams makeRenderParams(const RenderSettings& settings);

// Features that the settings need beyond those of the scene.
std::uint32_t settingsFeatures(const RenderSettings& settings);

}  // namespace rt::app
