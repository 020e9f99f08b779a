// Which of the two ways to trace rays a device is served best by.
#pragma once
#include "Common/App/Names.h"
#include "Common/Vulkan/DeviceSelection.h"

namespace rt::gpu {

// Whether compute shaders serve better than the device's ray tracing pipelines: on a device that is the processor itself, where
// both are programs, but one of them pays for shader calls. On a GPU without hardware for rays (an NVIDIA H200) they were
// measured to be 2 to 3 times as fast too, but its driver takes from ten seconds to minutes to compile them, so that there
// they are only for those who ask for them.
bool computeIsFaster(const vulkan::DeviceInfo& device);

// `wish`, or for Auto what is there and faster. Throws NoDeviceError when the device has no pipeline and one is wished for.
app::GpuEngineKind chooseEngine(app::GpuEngineKind wish, const vulkan::DeviceInfo& device);

} // namespace rt::gpu
