#include "RayTracingGPU/Kernels.h"

#include <algorithm>

#include "Common/Shared/Material/Materials.h"
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

// What only the full shaders have, see RT_FULL in Common/Shared/Base/Shim.h.
constexpr std::uint32_t kFeaturesOfFull =
    shared::kFeatureProjected | shared::kFeaturePrincipled | shared::kFeatureOpacity | shared::kFeatureCoatNormal;

Shaders shadersFor(KernelPurpose purpose, bool full) {
    switch (purpose) {
        case KernelPurpose::FirstHits:
            return {Shader::AovGeneration, Shader::AovCompute}; // full as well
        case KernelPurpose::Rays:
            return full ? Shaders{Shader::FullCostGeneration, Shader::FullCostCompute}
                        : Shaders{Shader::CostGeneration, Shader::CostCompute};
        case KernelPurpose::Time:
            return full ? Shaders{Shader::FullTimeGeneration, Shader::FullTimeCompute}
                        : Shaders{Shader::TimeGeneration, Shader::TimeCompute};
        case KernelPurpose::Paths:
            break;
    }
    return full ? Shaders{Shader::FullRayGeneration, Shader::FullPathCompute}
                : Shaders{Shader::RayGeneration, Shader::PathCompute};
}

} // namespace

std::unique_ptr<Kernel> makeKernel(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache,
                                   const RenderBindings& bindings, app::GpuEngineKind engine, KernelPurpose purpose,
                                   const SpecializationConstants& constants) {
    const Shaders shaders = shadersFor(purpose, shared::has(constants.features, kFeaturesOfFull));
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
