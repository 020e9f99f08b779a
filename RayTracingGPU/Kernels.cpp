#include "RayTracingGPU/Kernels.h"

#include <algorithm>

#include "Common/Shared/Base/Features.h"
#include "RayTracingGPU/ComputePipeline.h"
#include "RayTracingGPU/RtPipeline.h"

namespace rt::gpu {
namespace {

constexpr std::uint32_t kInvocations = 1u << 17;     // fill the largest GPUs
constexpr std::uint32_t kSoftInvocations = 1u << 14; // fill the largest processors

struct Shaders {
    Shader rayGeneration;
    Shader compute;
};

// `projected`: lights are sampled by projected solid angle.
Shaders shadersFor(KernelPurpose purpose, bool projected) {
    switch (purpose) {
        case KernelPurpose::FirstHits:
            return {Shader::AovGeneration, Shader::AovCompute}; // no lights are sampled
        case KernelPurpose::Rays:
            return projected ? Shaders{Shader::ProjectedCostGeneration, Shader::ProjectedCostCompute}
                             : Shaders{Shader::CostGeneration, Shader::CostCompute};
        case KernelPurpose::Time:
            return projected ? Shaders{Shader::ProjectedTimeGeneration, Shader::ProjectedTimeCompute}
                             : Shaders{Shader::TimeGeneration, Shader::TimeCompute};
        case KernelPurpose::Paths:
            break;
    }
    return projected ? Shaders{Shader::ProjectedRayGeneration, Shader::ProjectedPathCompute}
                     : Shaders{Shader::RayGeneration, Shader::PathCompute};
}

} // namespace

std::unique_ptr<Kernel> makeKernel(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache,
                                   const RenderBindings& bindings, app::GpuEngineKind engine, KernelPurpose purpose,
                                   const SpecializationConstants& constants) {
    const Shaders shaders = shadersFor(purpose, shared::has(constants.features, shared::kFeatureProjected));
    if (engine != app::GpuEngineKind::Compute) {
        return std::make_unique<RtPipeline>(context, cache, bindings, constants, shaders.rayGeneration);
    }
    return std::make_unique<ComputePipeline>(context, cache, bindings, constants, shaders.compute);
}

std::uint32_t maxInvocations(const vulkan::VulkanContext& context, app::GpuEngineKind engine) {
    const std::uint32_t filling = context.info().isSoftware() ? kSoftInvocations : kInvocations;
    if (engine == app::GpuEngineKind::Compute) return filling;
    return std::min(filling, context.limits().maxInvocations);
}

} // namespace rt::gpu
