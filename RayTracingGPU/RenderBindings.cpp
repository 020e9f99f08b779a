#include "RayTracingGPU/RenderBindings.h"

#include <array>

#include "Common/Vulkan/Check.h"

namespace rt::gpu {
namespace {

// As in the shaders.
constexpr std::uint32_t kTopLevel = 0;
constexpr std::uint32_t kConstants = 1;
constexpr std::uint32_t kFlatLists = 2;

constexpr VkShaderStageFlags kComputeStage = VK_SHADER_STAGE_COMPUTE_BIT;
constexpr VkShaderStageFlags kRayGenerationStage = VK_SHADER_STAGE_RAYGEN_BIT_KHR;
constexpr VkShaderStageFlags kPipelineStages = VK_SHADER_STAGE_RAYGEN_BIT_KHR | VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR |
                                               VK_SHADER_STAGE_MISS_BIT_KHR | VK_SHADER_STAGE_INTERSECTION_BIT_KHR;

} // namespace

RenderBindings::RenderBindings(vulkan::VulkanContext& context, app::GpuEngineKind engine, std::uint32_t pushBytes)
    : device_(context.device()) {
    const bool compute = engine == app::GpuEngineKind::Compute;
    bindPoint_ = compute ? VK_PIPELINE_BIND_POINT_COMPUTE : VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR;
    pushStages_ = compute ? kComputeStage : kRayGenerationStage;
    const VkShaderStageFlags stages = compute ? kComputeStage : kPipelineStages;
    const VkDescriptorType traced =
        compute ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR;
    const std::array<VkDescriptorSetLayoutBinding, 2> bindings{{
        {kConstants, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, stages, nullptr},
        {compute ? kFlatLists : kTopLevel, traced, 1, pushStages_, nullptr},
    }};
    VkDescriptorSetLayoutCreateInfo setInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    setInfo.bindingCount = static_cast<std::uint32_t>(bindings.size());
    setInfo.pBindings = bindings.data();
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    vulkan::check(vkCreateDescriptorSetLayout(device_, &setInfo, nullptr, &setLayout), "Creating bindings");
    setLayout_ = {device_, setLayout, vkDestroyDescriptorSetLayout};

    const VkPushConstantRange push{pushStages_, 0, pushBytes};
    VkPipelineLayoutCreateInfo layoutInfo{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layoutInfo.setLayoutCount = 1;
    layoutInfo.pSetLayouts = &setLayout;
    layoutInfo.pushConstantRangeCount = 1;
    layoutInfo.pPushConstantRanges = &push;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    vulkan::check(vkCreatePipelineLayout(device_, &layoutInfo, nullptr, &layout), "Creating bindings");
    pipelineLayout_ = {device_, layout, vkDestroyPipelineLayout};

    const std::array<VkDescriptorPoolSize, 2> sizes{{{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1}, {traced, 1}}};
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

void RenderBindings::write(std::uint32_t binding, VkDescriptorType type, const void* next,
                           const VkDescriptorBufferInfo* buffer) {
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, next};
    write.dstSet = set_;
    write.dstBinding = binding;
    write.descriptorCount = 1;
    write.descriptorType = type;
    write.pBufferInfo = buffer;
    vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
}

void RenderBindings::writeUniforms(std::uint32_t binding, const vulkan::Buffer& buffer) {
    const VkDescriptorBufferInfo info{buffer.get(), 0, VK_WHOLE_SIZE};
    write(binding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, nullptr, &info);
}

void RenderBindings::update(const vulkan::Buffer& constants, VkAccelerationStructureKHR topLevel) {
    writeUniforms(kConstants, constants);
    VkWriteDescriptorSetAccelerationStructureKHR structure{
        VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR};
    structure.accelerationStructureCount = 1;
    structure.pAccelerationStructures = &topLevel;
    write(kTopLevel, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, &structure, nullptr);
}

void RenderBindings::update(const vulkan::Buffer& constants, const vulkan::Buffer& flatLists) {
    writeUniforms(kConstants, constants);
    writeUniforms(kFlatLists, flatLists);
}

void RenderBindings::bind(VkCommandBuffer commands, const void* push, std::uint32_t pushBytes) const {
    vkCmdBindDescriptorSets(commands, bindPoint_, layout(), 0, 1, &set_, 0, nullptr);
    vkCmdPushConstants(commands, layout(), pushStages_, 0, pushBytes, push);
}

} // namespace rt::gpu
