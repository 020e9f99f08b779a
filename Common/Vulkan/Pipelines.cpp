#include "Common/Vulkan/Pipelines.h"

#include <array>
#include <vector>

#include "Common/Vulkan/Check.h"
#include "Common/Vulkan/Create.h"
#include "Common/Vulkan/ShaderPruning.h"

namespace rt::vulkan {

Handle<VkShaderModule> makeShaderModule(VkDevice device, std::span<const std::uint32_t> code) {
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = code.size_bytes();
    info.pCode = code.data();
    return create(device, vkCreateShaderModule, info, vkDestroyShaderModule, "Loading a shader");
}

Handle<VkShaderModule> makeShaderModule(VkDevice device, std::span<const std::uint32_t> code,
                                        const VkSpecializationInfo& constants) {
    return makeShaderModule(device, prunedShader(code, constants));
}

VkPipelineShaderStageCreateInfo shaderStage(VkShaderStageFlagBits stage, VkShaderModule module,
                                            const VkSpecializationInfo* constants) {
    VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
    info.stage = stage;
    info.module = module;
    info.pName = "main";
    info.pSpecializationInfo = constants;
    return info;
}

Handle<VkPipelineLayout> makePipelineLayout(VkDevice device, const VkPushConstantRange& push, VkDescriptorSetLayout set,
                                            const char* what) {
    VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    if (set != VK_NULL_HANDLE) {
        info.setLayoutCount = 1;
        info.pSetLayouts = &set;
    }
    info.pushConstantRangeCount = 1;
    info.pPushConstantRanges = &push;
    return create(device, vkCreatePipelineLayout, info, vkDestroyPipelineLayout, what);
}

Handle<VkPipeline> makeComputePipeline(VkDevice device, VkPipelineCache cache, VkPipelineLayout layout,
                                       VkShaderModule module, const VkSpecializationInfo* constants, const char* what,
                                       VkPipelineCreateFlags flags) {
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.flags = flags;
    info.stage = shaderStage(VK_SHADER_STAGE_COMPUTE_BIT, module, constants);
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    check(vkCreateComputePipelines(device, cache, 1, &info, nullptr, &pipeline), what);
    return {device, pipeline, vkDestroyPipeline};
}

Handle<VkPipeline> makeGraphicsPipeline(VkDevice device, VkPipelineCache cache, VkPipelineLayout layout,
                                        VkRenderPass renderPass,
                                        std::span<const VkPipelineShaderStageCreateInfo> stages,
                                        const Rasterization& rasterization, const char* what) {
    const VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.polygonMode = VK_POLYGON_MODE_FILL;
    raster.cullMode = rasterization.cull;
    raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    raster.lineWidth = 1;
    VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    samples.rasterizationSamples = rasterization.samples;
    samples.sampleShadingEnable = rasterization.shadesSamples ? VK_TRUE : VK_FALSE;
    samples.minSampleShading = 1;
    VkPipelineColorBlendAttachmentState attachment{};
    attachment.colorWriteMask =
        VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = 1;
    blend.pAttachments = &attachment;
    constexpr std::array kDynamic{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamic.dynamicStateCount = static_cast<std::uint32_t>(kDynamic.size());
    dynamic.pDynamicStates = kDynamic.data();

    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
    info.stageCount = static_cast<std::uint32_t>(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = rasterization.depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = layout;
    info.renderPass = renderPass;
    VkPipeline pipeline = VK_NULL_HANDLE;
    check(vkCreateGraphicsPipelines(device, cache, 1, &info, nullptr, &pipeline), what);
    return {device, pipeline, vkDestroyPipeline};
}

DescriptorSet::DescriptorSet(VkDevice device, std::span<const VkDescriptorSetLayoutBinding> bindings, const char* what)
    : device_(device) {
    VkDescriptorSetLayoutCreateInfo layoutInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    layoutInfo.bindingCount = static_cast<std::uint32_t>(bindings.size());
    layoutInfo.pBindings = bindings.data();
    layout_ = create(device, vkCreateDescriptorSetLayout, layoutInfo, vkDestroyDescriptorSetLayout, what);

    std::vector<VkDescriptorPoolSize> sizes;
    for (const VkDescriptorSetLayoutBinding& binding : bindings)
        sizes.push_back({binding.descriptorType, binding.descriptorCount});
    VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    poolInfo.pPoolSizes = sizes.data();
    pool_ = create(device, vkCreateDescriptorPool, poolInfo, vkDestroyDescriptorPool, what);

    VkDescriptorSetAllocateInfo allocation{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocation.descriptorPool = pool_.get();
    allocation.descriptorSetCount = 1;
    const VkDescriptorSetLayout layout = layout_.get();
    allocation.pSetLayouts = &layout;
    check(vkAllocateDescriptorSets(device, &allocation, &set_), what);
}

void DescriptorSet::update(std::uint32_t binding, VkWriteDescriptorSet what) const {
    what.dstSet = set_;
    what.dstBinding = binding;
    what.descriptorCount = 1;
    vkUpdateDescriptorSets(device_, 1, &what, 0, nullptr);
}

void DescriptorSet::write(std::uint32_t binding, VkDescriptorType type, VkBuffer buffer) const {
    const VkDescriptorBufferInfo info{buffer, 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.descriptorType = type;
    write.pBufferInfo = &info;
    update(binding, write);
}

void DescriptorSet::write(std::uint32_t binding, VkImageView sampled) const {
    const VkDescriptorImageInfo info{VK_NULL_HANDLE, sampled, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.descriptorType = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    write.pImageInfo = &info;
    update(binding, write);
}

void DescriptorSet::write(std::uint32_t binding, VkAccelerationStructureKHR structure) const {
    VkWriteDescriptorSetAccelerationStructureKHR info{
        VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR};
    info.accelerationStructureCount = 1;
    info.pAccelerationStructures = &structure;
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, &info};
    write.descriptorType = VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR;
    update(binding, write);
}

} // namespace rt::vulkan
