#pragma once
#include "Common/App/Settings.h"
#include "Common/Shared/Types.h"

namespace rt::app {

// The settings as kernels see them.
shared::RenderParams makeRenderParams(const RenderSettings& settings);

}  // namespace rt::app
