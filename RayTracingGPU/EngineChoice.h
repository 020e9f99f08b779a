// Which of the two ways to trace rays a device is served best by.
#pragma once
#include "Common/App/Options/Names.h"
#include "Common/Vulkan/DeviceSelection.h"

namespace rt::gpu {

// Whether compute shaders serve better than the device's ray tracing pipelines, which they do where those are programs,
// too: on a device that is the processor itself, and on a GPU without hardware for rays, which an NVIDIA H200 is
// (measured there: 2.8 to 3.4 times as fast, from Cornell Box Lights to One Weekend). Vulkan does not tell about
// hardware; but drivers offer ray queries only with it.
bool computeIsFaster(const vulkan::DeviceInfo& device);

// `wish`, or for Auto what is there and faster. Throws NoDeviceError when the device has no pipeline and one is wished
// for.
app::GpuEngineKind chooseEngine(app::GpuEngineKind wish, const vulkan::DeviceInfo& device);

} // namespace rt::gpu
