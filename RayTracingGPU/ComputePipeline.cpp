#include "RayTracingGPU/ComputePipeline.h"

#include <array>

#include "Common/Shared/Features.h"
#include "Common/Vulkan/Check.h"

namespace rt::gpu {
namespace {

// All specialisation constants side by side.
struct Constants {
    PipelineDecisions decisions;
    TraversalShape shape;
};

std::string describe(std::uint32_t features, bool isFlat) {
    std::string name = isFlat ? "flat" : "tree";
    if (shared::has(features, shared::kFeatureTriangles)) name += "+triangles";
    if (shared::has(features, shared::kFeatureQuads)) name += "+quads";
    if (shared::has(features, shared::kFeatureSpheres)) name += "+spheres";
    if (!isFlat && shared::has(features, shared::kFeatureInstances)) name += "+instances";
    return name;
}

} // namespace

TraversalShape traversalShape(const accel::GpuBvh& bvh) {
    constexpr std::uint32_t kDepthStep = 4; // so that scenes of nearly the same depth share a pipeline
    TraversalShape shape;
    shape.treeDepth = bvh.isFlat ? 0 : (bvh.trees.depth + kDepthStep - 1) / kDepthStep * kDepthStep;
    shape.isFlat = bvh.isFlat ? 1 : 0;
    shape.flatSpheres = bvh.flat.spheres;
    shape.flatQuads = bvh.flat.quads;
    shape.flatTriangles = bvh.flat.triangles;
    return shape;
}

ComputePipeline::ComputePipeline(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache,
                                 const RenderBindings& bindings, const PipelineDecisions& decisions,
                                 const TraversalShape& shape, Shader shader)
    : bindings_(bindings), name_(describe(decisions.features, shape.isFlat != 0)) {
    const Constants constants{decisions, shape};
    constexpr std::uint32_t kCount = sizeof constants / sizeof(std::uint32_t);
    std::array<VkSpecializationMapEntry, kCount> entries;
    for (std::uint32_t i = 0; i < kCount; ++i) entries[i] = {i, i * 4, 4};
    const VkSpecializationInfo specialization{kCount, entries.data(), sizeof constants, &constants};

    const vulkan::Handle<VkShaderModule> module = makeShaderModule(context.device(), shader);
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module.get();
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = &specialization;
    info.layout = bindings.layout();
    VkPipeline pipeline = VK_NULL_HANDLE;
    vulkan::check(vkCreateComputePipelines(context.device(), cache.get(), 1, &info, nullptr, &pipeline),
                  "Creating the compute pipeline");
    pipeline_ = {context.device(), pipeline, vkDestroyPipeline};
}

void ComputePipeline::record(VkCommandBuffer commands, const void* launch, std::uint32_t bytes,
                             std::uint32_t invocations) const {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
    bindings_.bind(commands, launch, bytes);
    vkCmdDispatch(commands, (invocations + kGroupSize - 1) / kGroupSize, 1, 1);
}

} // namespace rt::gpu
