// What `auto` is: the engine that is fastest on this device for scenes like the one at hand, by measurement.
#pragma once
#include <memory>

#include "RayTracingGPU/GpuEngine.h"

namespace rt::gpu {

// Of a device that has several engines. A scene of a class that is new to the device (EngineRates.h) is rendered by
// each of them for a few launches, with its own camera and default settings: by one after the other, each of which is
// gone before the next is made. All scenes of the class are left to the fastest from then on, in other runs as well.
std::unique_ptr<app::Engine> makeMeasuredEngine(vulkan::VulkanContext& context, const GpuEngineOptions& options);

} // namespace rt::gpu
