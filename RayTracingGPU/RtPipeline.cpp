#include "RayTracingGPU/RtPipeline.h"

#include <array>
#include <cstddef>
#include <vector>

#include "Common/Shared/Features.h"
#include "Common/Vulkan/Check.h"
#include "Shaders/Records.h"

namespace rt::gpu {
namespace {

constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_RAYGEN_BIT_KHR | VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR |
                                       VK_SHADER_STAGE_MISS_BIT_KHR | VK_SHADER_STAGE_INTERSECTION_BIT_KHR;

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
        VkRayTracingShaderGroupCreateInfoKHR group = emptyGroup(VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR);
        group.closestHitShader = addStage(VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR, closestHit);
        return add(group);
    }
    std::uint32_t addProcedural(Shader closestHit, Shader intersection) {
        VkRayTracingShaderGroupCreateInfoKHR group = emptyGroup(VK_RAY_TRACING_SHADER_GROUP_TYPE_PROCEDURAL_HIT_GROUP_KHR);
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
        modules_.push_back(makeShaderModule(device_, shader));
        VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
        info.stage = stage;
        info.module = modules_.back().get();
        info.pName = "main";
        info.pSpecializationInfo = &constants_;
        stages_.push_back(info);
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

ShaderGroups addGroups(GroupList& list, const PipelineDecisions& decisions, Shader rayGeneration, std::string& name) {
    const std::uint32_t features = decisions.features;
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
    groups.count = static_cast<std::uint32_t>(list.groups().size());
    return groups;
}

}  // namespace

PipelineDecisions makeDecisions(std::uint32_t features, const shared::RenderParams& params) {
    return {features,         params.lightSampling, params.lightSelection, params.sphereLight,
            params.quadLight, params.triangleLight, params.samplerKind,    params.russianRoulette};
}

vulkan::Handle<VkShaderModule> makeShaderModule(VkDevice device, Shader shader) {
    const std::span<const std::uint32_t> code = shaderCode(shader);
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = code.size_bytes();
    info.pCode = code.data();
    VkShaderModule module = VK_NULL_HANDLE;
    vulkan::check(vkCreateShaderModule(device, &info, nullptr, &module), "Loading a shader");
    return {device, module, vkDestroyShaderModule};
}

// ---- bindings --------------------------------------------------------------------------------------------------------

RenderBindings::RenderBindings(vulkan::VulkanContext& context, std::uint32_t pushBytes) : device_(context.device()) {
    const std::array<VkDescriptorSetLayoutBinding, 2> bindings{{
        {0, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1, VK_SHADER_STAGE_RAYGEN_BIT_KHR, nullptr},
        {1, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, kStages, nullptr},
    }};
    VkDescriptorSetLayoutCreateInfo setInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    setInfo.bindingCount = static_cast<std::uint32_t>(bindings.size());
    setInfo.pBindings = bindings.data();
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    vulkan::check(vkCreateDescriptorSetLayout(device_, &setInfo, nullptr, &setLayout), "Creating bindings");
    setLayout_ = {device_, setLayout, vkDestroyDescriptorSetLayout};

    const VkPushConstantRange push{VK_SHADER_STAGE_RAYGEN_BIT_KHR, 0, pushBytes};
    VkPipelineLayoutCreateInfo layoutInfo{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layoutInfo.setLayoutCount = 1;
    layoutInfo.pSetLayouts = &setLayout;
    layoutInfo.pushConstantRangeCount = 1;
    layoutInfo.pPushConstantRanges = &push;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    vulkan::check(vkCreatePipelineLayout(device_, &layoutInfo, nullptr, &layout), "Creating bindings");
    pipelineLayout_ = {device_, layout, vkDestroyPipelineLayout};

    const std::array<VkDescriptorPoolSize, 2> sizes{
        {{VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1}, {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1}}};
    VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    poolInfo.pPoolSizes = sizes.data();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    vulkan::check(vkCreateDescriptorPool(device_, &poolInfo, nullptr, &pool), "Creating bindings");
    pool_ = {device_, pool, vkDestroyDescriptorPool};

    VkDescriptorSetAllocateInfo allocation{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocation.descriptorPool = pool;
    allocation.descriptorSetCount = 1;
    allocation.pSetLayouts = &setLayout;
    vulkan::check(vkAllocateDescriptorSets(device_, &allocation, &set_), "Creating bindings");
}

void RenderBindings::update(VkAccelerationStructureKHR topLevel, const vulkan::Buffer& constants) {
    VkWriteDescriptorSetAccelerationStructureKHR structure{
        VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR};
    structure.accelerationStructureCount = 1;
    structure.pAccelerationStructures = &topLevel;
    const VkDescriptorBufferInfo buffer{constants.get(), 0, VK_WHOLE_SIZE};
    std::array<VkWriteDescriptorSet, 2> writes{};
    for (std::uint32_t i = 0; i < writes.size(); ++i) {
        writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        writes[i].dstSet = set_;
        writes[i].dstBinding = i;
        writes[i].descriptorCount = 1;
    }
    writes[0].pNext = &structure;
    writes[0].descriptorType = VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR;
    writes[1].descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    writes[1].pBufferInfo = &buffer;
    vkUpdateDescriptorSets(device_, static_cast<std::uint32_t>(writes.size()), writes.data(), 0, nullptr);
}

void RenderBindings::bind(VkCommandBuffer commands) const {
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, layout(), 0, 1, &set_, 0, nullptr);
}

// ---- pipeline --------------------------------------------------------------------------------------------------------

RtPipeline::RtPipeline(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache, const RenderBindings& bindings,
                       const PipelineDecisions& decisions, Shader rayGeneration)
    : decisions_(decisions) {
    constexpr std::uint32_t kConstants = sizeof(PipelineDecisions) / sizeof(std::uint32_t);
    std::array<VkSpecializationMapEntry, kConstants> entries;
    for (std::uint32_t i = 0; i < kConstants; ++i) entries[i] = {i, i * 4, 4};
    const VkSpecializationInfo constants{kConstants, entries.data(), sizeof decisions_, &decisions_};

    GroupList list(context.device(), constants);
    const ShaderGroups groups = addGroups(list, decisions, rayGeneration, name_);
    VkRayTracingPipelineCreateInfoKHR info{VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR};
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

}  // namespace rt::gpu
