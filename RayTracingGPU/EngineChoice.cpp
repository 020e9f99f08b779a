#include "RayTracingGPU/EngineChoice.h"

#include <algorithm>

#include "Common/Vulkan/Check.h"

namespace rt::gpu {

using app::GpuEngineKind;

vulkan::RayTracing neededBy(GpuEngineKind engine) {
    return engine == GpuEngineKind::Pipeline ? vulkan::RayTracing::Pipeline
           : engine == GpuEngineKind::Query  ? vulkan::RayTracing::Query
                                             : vulkan::RayTracing::None;
}

void requireEngine(GpuEngineKind engine, const vulkan::DeviceInfo& device) {
    if (device.serves(neededBy(engine))) return;
    const bool isQuery = engine == GpuEngineKind::Query;
    throw vulkan::NoDeviceError(device.name + " does not have " + (isQuery ? "ray queries" : "a ray tracing pipeline") +
                                ": it lacks " + (isQuery ? device.missingForQuery : device.missingForPipeline));
}

std::vector<GpuEngineKind> enginesOf(const vulkan::DeviceInfo& device) {
    const bool hasHardware = !device.isSoftware() && device.queriesRays();
    std::vector<GpuEngineKind> engines{GpuEngineKind::Query, GpuEngineKind::Pipeline, GpuEngineKind::Compute};
    if (hasHardware) std::swap(engines.front(), engines.back());
    if (hasHardware) std::swap(engines[1], engines[2]);
    std::erase_if(engines, [&](GpuEngineKind engine) { return !device.serves(neededBy(engine)); });
    return engines;
}

} // namespace rt::gpu
