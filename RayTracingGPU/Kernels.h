// What the engine runs over pixels and samples, by its purpose, for each way of tracing rays.
#pragma once
#include <cstdint>
#include <memory>

#include "Common/App/Options/Names.h"
#include "Common/Vulkan/PipelineCache.h"
#include "Common/Vulkan/VulkanContext.h"
#include "RayTracingGPU/Kernel.h"
#include "RayTracingGPU/RenderBindings.h"
#include "RayTracingGPU/SpecializationConstants.h"

namespace rt::gpu {

enum class KernelPurpose {
    Paths,     // samples of the film
    Reuse,     // what pixels share of them
    FirstHits, // albedo, normal, depth
    Rays,      // rays that a pixel costs
    Time,      // ticks that it takes; of devices with a shader clock
};

// Of an engine that was chosen. `bindings` must outlive it. Throws RenderError.
std::unique_ptr<Kernel> makeKernel(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache,
                                   const RenderBindings& bindings, app::GpuEngineKind engine, KernelPurpose purpose,
                                   const SpecializationConstants& constants);

// Invocations of a work group of compute shaders that have these features, as measured.
std::uint32_t groupSize(const vulkan::VulkanContext& context, shared::Features features);

// That share the work of a launch, at most: enough to fill the largest devices.
std::uint32_t maxInvocations(const vulkan::VulkanContext& context, app::GpuEngineKind engine);

} // namespace rt::gpu
