#include "RayTracingGPU/EngineChoice.h"

#include "Common/Vulkan/Check.h"

namespace rt::gpu {

using app::GpuEngineKind;

bool computeIsFaster(const vulkan::DeviceInfo& device) {
    return device.isSoftware() || !device.hasRayQueries;
}

GpuEngineKind chooseEngine(GpuEngineKind wish, const vulkan::DeviceInfo& device) {
    if (wish == GpuEngineKind::Pipeline && !device.tracesRays()) {
        throw vulkan::NoDeviceError(device.name + " has no ray tracing pipeline: it lacks " +
                                    device.missingForPipeline);
    }
    if (wish != GpuEngineKind::Auto) return wish;
    return device.tracesRays() && !computeIsFaster(device) ? GpuEngineKind::Pipeline : GpuEngineKind::Compute;
}

} // namespace rt::gpu
