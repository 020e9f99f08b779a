// Which ways to trace rays a device has, and how they differ.
#pragma once
#include <vector>

#include "Common/Render/Names.h"
#include "Common/Vulkan/DeviceSelection.h"

namespace rt::gpu {

// Whether rays go through an acceleration structure of the device, not through a tree of our own.
inline bool usesAccelStructure(app::GpuEngineKind engine) {
    return engine != app::GpuEngineKind::Compute;
}

// What a device must have for an engine; for Auto nothing beyond compute shaders.
vulkan::RayTracing neededBy(app::GpuEngineKind engine);

// Throws NoDeviceError when the device does not have what the engine needs.
void requireEngine(app::GpuEngineKind engine, const vulkan::DeviceInfo& device);

// The engines that a device has, at least one. The last one is likely to be the fastest: compute shaders where
// pipelines are programs, too, as on a processor and on a GPU without hardware for rays. Vulkan does not tell about
// hardware; but drivers offer ray queries only with it, or where they are programs themselves.
std::vector<app::GpuEngineKind> enginesOf(const vulkan::DeviceInfo& device);

} // namespace rt::gpu
