#include "RayTracingGPU/ComputePipeline.h"

#include <array>

#include "Common/Shared/Base/Features.h"
#include "Common/Vulkan/Pipelines.h"

namespace rt::gpu {
namespace {

// All specialisation constants side by side.
struct Constants {
    PipelineDecisions decisions;
    TraversalShape shape;
};

std::string describe(std::uint32_t features, bool isLinear) {
    std::string name = isLinear ? "list" : "tree";
    if (shared::has(features, shared::kFeatureTriangles)) name += "+triangles";
    if (shared::has(features, shared::kFeatureQuads)) name += "+quads";
    if (shared::has(features, shared::kFeatureSpheres)) name += "+spheres";
    if (!isLinear && shared::has(features, shared::kFeatureInstances)) name += "+instances";
    return name;
}

} // namespace

TraversalShape traversalShape(const accel::GpuBvh& bvh) {
    constexpr std::uint32_t kDepthStep = 4; // so that scenes of nearly the same depth share a pipeline
    TraversalShape shape;
    shape.treeDepth = bvh.isLinear ? 0 : (bvh.trees.depth + kDepthStep - 1) / kDepthStep * kDepthStep;
    shape.isLinear = bvh.isLinear ? 1 : 0;
    shape.listedSpheres = bvh.lists.spheres;
    shape.listedQuads = bvh.lists.quads;
    shape.listedTriangles = bvh.lists.triangles;
    return shape;
}

ComputePipeline::ComputePipeline(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache,
                                 const RenderBindings& bindings, const PipelineDecisions& decisions,
                                 const TraversalShape& shape, Shader shader)
    : bindings_(bindings), name_(describe(decisions.features, shape.isLinear != 0)) {
    const Constants constants{decisions, shape};
    constexpr std::uint32_t kCount = sizeof constants / sizeof(std::uint32_t);
    std::array<VkSpecializationMapEntry, kCount> entries;
    for (std::uint32_t i = 0; i < kCount; ++i) entries[i] = {i, i * 4, 4};
    const VkSpecializationInfo specialization{kCount, entries.data(), sizeof constants, &constants};

    const auto module = vulkan::makeShaderModule(context.device(), shaderCode(shader));
    pipeline_ = vulkan::makeComputePipeline(context.device(), cache.get(), bindings.layout(), module.get(),
                                            &specialization, "Creating the compute pipeline");
}

void ComputePipeline::record(VkCommandBuffer commands, const void* launch, std::uint32_t bytes,
                             std::uint32_t invocations) const {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
    bindings_.bind(commands, launch, bytes);
    vkCmdDispatch(commands, (invocations + kGroupSize - 1) / kGroupSize, 1, 1);
}

} // namespace rt::gpu
