#include "RayTracingGPU/Kernels.h"

#include <algorithm>

#include "Common/Shared/Light/RoundLight.h"
#include "Common/Shared/Material/Materials.h"
#include "RayTracingGPU/ComputePipeline.h"
#include "RayTracingGPU/RtPipeline.h"

namespace rt::gpu {
namespace {

constexpr std::uint32_t kInvocations = 1u << 17;     // fill the largest GPUs
constexpr std::uint32_t kSoftInvocations = 1u << 14; // fill the largest processors

// Whose code needs many registers.
constexpr shared::Features kHeavyFeatures = shared::kMethodProjected | shared::kFeaturePrincipled |
                                            shared::kFeatureOpacity | shared::kFeatureCoatNormal |
                                            shared::kMethodConnections | shared::kRoundLightFeatures;

// The first of a purpose's kernels; the others follow it by engine, see RT_GPU_KERNELS.
Shader firstOf(KernelPurpose purpose) {
    switch (purpose) {
        case KernelPurpose::Reuse:
            return Shader::ReusePipeline;
        case KernelPurpose::FirstHits:
            return Shader::FirstHitsPipeline;
        case KernelPurpose::Rays:
            return Shader::RaysPipeline;
        case KernelPurpose::Time:
            return Shader::TimePipeline;
        case KernelPurpose::Paths:
            break;
    }
    return Shader::PathsPipeline;
}

Shader shaderFor(KernelPurpose purpose, app::GpuEngineKind engine) {
    const int place = engine == app::GpuEngineKind::Pipeline ? 0 : engine == app::GpuEngineKind::Compute ? 1 : 2;
    return static_cast<Shader>(static_cast<int>(firstOf(purpose)) + place);
}

} // namespace

std::unique_ptr<Kernel> makeKernel(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache,
                                   const RenderBindings& bindings, app::GpuEngineKind engine, KernelPurpose purpose,
                                   const SpecializationConstants& constants) {
    const Shader shader = shaderFor(purpose, engine);
    if (engine == app::GpuEngineKind::Pipeline) {
        return std::make_unique<RtPipeline>(context, cache, bindings, constants, shader);
    }
    SpecializationConstants own = constants;
    // Few registers, so small groups fill the device.
    if (purpose == KernelPurpose::Reuse) own.traversal.groupSize = TraversalShape().groupSize;
    return std::make_unique<ComputePipeline>(context, cache, bindings, own, shader,
                                             engine == app::GpuEngineKind::Query);
}

// Of NVIDIA's shaders with lights 512 invocations have all registers of a multiprocessor between them, which take
// an H100 0.87 times as long as eight groups of 64 through lists and 0.97 to 0.99 through trees. Without lights, where
// more groups fit, they take 1.12 times as long.
std::uint32_t groupSize(const vulkan::VulkanContext& context, shared::Features features) {
    constexpr std::uint32_t kNvidia = 0x10de, kLarge = 512;
    const bool isMeasured = context.limits().vendor == kNvidia && shared::has(features, shared::kFeatureLights) &&
                            !shared::has(features, kHeavyFeatures);
    return isMeasured && context.limits().maxGroupSize >= kLarge ? kLarge : TraversalShape().groupSize;
}

std::uint32_t maxInvocations(const vulkan::VulkanContext& context, app::GpuEngineKind engine) {
    const std::uint32_t filling = context.info().isSoftware() ? kSoftInvocations : kInvocations;
    if (engine != app::GpuEngineKind::Pipeline) return filling;
    return std::min(filling, context.limits().maxInvocations);
}

} // namespace rt::gpu
