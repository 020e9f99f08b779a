#include "RayTracingGPU/ComputePipeline.h"

#include "Common/Shared/Base/Features.h"
#include "Common/Vulkan/Pipelines.h"
#include "Common/Vulkan/ShaderFigures.h"

namespace rt::gpu {
namespace {

std::string describe(shared::Features features, bool queries, bool isLinear) {
    std::string name = queries ? "queries" : isLinear ? "list" : "tree";
    if (shared::has(features, shared::kFeatureTriangles)) name += "+triangles";
    if (shared::has(features, shared::kFeatureQuads)) name += "+quads";
    if (shared::has(features, shared::kFeatureSpheres)) name += "+spheres";
    if (shared::has(features, shared::kRoundFeatures)) name += "+rounds";
    if ((queries || !isLinear) && shared::has(features, shared::kFeatureInstances)) name += "+instances";
    return name;
}

} // namespace

ComputePipeline::ComputePipeline(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache,
                                 const RenderBindings& bindings, const SpecializationConstants& constants,
                                 Shader shader, bool queries)
    : bindings_(bindings),
      name_(describe(constants.features, queries, constants.traversal.isLinear != 0)),
      groupSize_(constants.traversal.groupSize) {
    const VkSpecializationInfo specialization = specializationInfo(constants);
    const auto module = vulkan::makeShaderModule(context.device(), shaderCode(shader), specialization);
    pipeline_ =
        vulkan::makeComputePipeline(context.device(), cache.get(), bindings.layout(), module.get(), &specialization,
                                    "Creating the compute pipeline", vulkan::figureFlags(context));
}

void ComputePipeline::record(VkCommandBuffer commands, const void* launch, std::uint32_t bytes,
                             std::uint32_t invocations) const {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
    bindings_.bind(commands, launch, bytes);
    vkCmdDispatch(commands, (invocations + groupSize_ - 1) / groupSize_, 1, 1);
}

} // namespace rt::gpu
