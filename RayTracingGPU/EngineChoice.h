// Which of the two ways to trace rays a device is served best by.
#pragma once
#include "Common/App/Names.h"
#include "Common/Vulkan/DeviceSelection.h"

namespace rt::gpu {

// Whether compute shaders outrun the device's ray tracing pipelines. Hardware that traces rays also answers ray queries from
// any shader; a device with pipelines alone (data-centre GPUs), and one that is the processor itself, run their driver's
// traversal as a program like ours, with the cost of shader calls on top. Measured on an H200: 2.5 to 7 times.
bool computeIsFaster(const vulkan::DeviceInfo& device);

// `wish`, or for Auto what is there and faster. Throws NoDeviceError when the device has no pipeline and one is wished for.
app::GpuEngineKind chooseEngine(app::GpuEngineKind wish, const vulkan::DeviceInfo& device);

}  // namespace rt::gpu
