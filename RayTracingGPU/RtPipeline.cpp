#include "RayTracingGPU/RtPipeline.h"

#include <vector>

#include "Common/Shared/Base/Features.h"
#include "Common/Vulkan/Check.h"
#include "Common/Vulkan/Pipelines.h"
#include "Common/Vulkan/ShaderFigures.h"
#include "Shaders/Records.h"

namespace rt::gpu {
namespace {

// Collects the stages and groups of a pipeline.
class GroupList {
  public:
    GroupList(VkDevice device, const VkSpecializationInfo& constants) : device_(device), constants_(constants) {}

    std::uint32_t addGeneral(VkShaderStageFlagBits stage, Shader shader) {
        VkRayTracingShaderGroupCreateInfoKHR group = emptyGroup(VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR);
        group.generalShader = addStage(stage, shader);
        return add(group);
    }
    std::uint32_t addTriangles(Shader closestHit) {
        VkRayTracingShaderGroupCreateInfoKHR group =
            emptyGroup(VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR);
        group.closestHitShader = addStage(VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR, closestHit);
        return add(group);
    }
    std::uint32_t addProcedural(Shader closestHit, Shader intersection) {
        VkRayTracingShaderGroupCreateInfoKHR group =
            emptyGroup(VK_RAY_TRACING_SHADER_GROUP_TYPE_PROCEDURAL_HIT_GROUP_KHR);
        group.closestHitShader = addStage(VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR, closestHit);
        group.intersectionShader = addStage(VK_SHADER_STAGE_INTERSECTION_BIT_KHR, intersection);
        return add(group);
    }

    const std::vector<VkPipelineShaderStageCreateInfo>& stages() const { return stages_; }
    const std::vector<VkRayTracingShaderGroupCreateInfoKHR>& groups() const { return groups_; }

  private:
    static VkRayTracingShaderGroupCreateInfoKHR emptyGroup(VkRayTracingShaderGroupTypeKHR type) {
        VkRayTracingShaderGroupCreateInfoKHR group{VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR};
        group.type = type;
        group.generalShader = VK_SHADER_UNUSED_KHR;
        group.closestHitShader = VK_SHADER_UNUSED_KHR;
        group.anyHitShader = VK_SHADER_UNUSED_KHR;
        group.intersectionShader = VK_SHADER_UNUSED_KHR;
        return group;
    }
    std::uint32_t addStage(VkShaderStageFlagBits stage, Shader shader) {
        modules_.push_back(vulkan::makeShaderModule(device_, shaderCode(shader), constants_));
        stages_.push_back(vulkan::shaderStage(stage, modules_.back().get(), &constants_));
        return static_cast<std::uint32_t>(stages_.size() - 1);
    }
    std::uint32_t add(const VkRayTracingShaderGroupCreateInfoKHR& group) {
        groups_.push_back(group);
        return static_cast<std::uint32_t>(groups_.size() - 1);
    }

    VkDevice device_;
    const VkSpecializationInfo& constants_;
    std::vector<vulkan::Handle<VkShaderModule>> modules_;
    std::vector<VkPipelineShaderStageCreateInfo> stages_;
    std::vector<VkRayTracingShaderGroupCreateInfoKHR> groups_;
};

ShaderGroups addGroups(GroupList& list, const SpecializationConstants& constants, Shader rayGeneration,
                       std::string& name) {
    const shared::Features features = constants.features;
    ShaderGroups groups;
    groups.hit.resize(shared::kHitRecords);
    groups.rayGeneration = list.addGeneral(VK_SHADER_STAGE_RAYGEN_BIT_KHR, rayGeneration);
    groups.miss = list.addGeneral(VK_SHADER_STAGE_MISS_BIT_KHR, Shader::Miss);
    name = "paths";
    if (shared::has(features, shared::kFeatureTriangles)) {
        groups.hit[shared::kHitRecordTriangle] = list.addTriangles(Shader::TriangleHit);
        name += "+triangles";
    }
    if (shared::has(features, shared::kFeatureQuads)) {
        groups.hit[shared::kHitRecordQuad] = list.addTriangles(Shader::QuadHit);
        name += "+quads";
    }
    if (shared::has(features, shared::kFeatureSpheres)) {
        groups.hit[shared::kHitRecordSphere] = list.addProcedural(Shader::SphereHit, Shader::SphereIntersection);
        name += "+spheres";
    }
    if (shared::has(features, shared::kRoundFeatures)) {
        groups.hit[shared::kHitRecordRound] = list.addProcedural(Shader::RoundHit, Shader::RoundIntersection);
        name += "+rounds";
    }
    groups.count = static_cast<std::uint32_t>(list.groups().size());
    return groups;
}

} // namespace

RtPipeline::RtPipeline(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache,
                       const RenderBindings& bindings, const SpecializationConstants& constants, Shader rayGeneration)
    : bindings_(bindings) {
    const VkSpecializationInfo specialization = specializationInfo(constants);
    GroupList list(context.device(), specialization);
    const ShaderGroups groups = addGroups(list, constants, rayGeneration, name_);
    VkRayTracingPipelineCreateInfoKHR info{VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR};
    info.flags = vulkan::figureFlags(context);
    info.stageCount = static_cast<std::uint32_t>(list.stages().size());
    info.pStages = list.stages().data();
    info.groupCount = groups.count;
    info.pGroups = list.groups().data();
    info.maxPipelineRayRecursionDepth = 1;
    info.layout = bindings.layout();
    VkPipeline pipeline = VK_NULL_HANDLE;
    vulkan::check(context.rayTracing().createPipelines(context.device(), VK_NULL_HANDLE, cache.get(), 1, &info, nullptr,
                                                       &pipeline),
                  "Creating the ray tracing pipeline");
    pipeline_ = {context.device(), pipeline, vkDestroyPipeline};
    table_ = std::make_unique<ShaderTable>(context, pipeline, groups);
}

void RtPipeline::record(VkCommandBuffer commands, const void* launch, std::uint32_t bytes,
                        std::uint32_t invocations) const {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, pipeline_.get());
    bindings_.bind(commands, launch, bytes);
    table_->trace(commands, invocations);
}

} // namespace rt::gpu
