#include "Common/Gui/FilmPass.h"

#include <cstring>

#include "Common/Vulkan/Check.h"
#include "Present.frag.h"
#include "Present.vert.h"

namespace rt::gui {
namespace {

using vulkan::check;
using vulkan::Handle;

constexpr VkMemoryPropertyFlags kMapped = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;

template <std::size_t N>
Handle<VkShaderModule> shaderModule(VkDevice device, const std::uint32_t (&words)[N]) {
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = sizeof words;
    info.pCode = words;
    VkShaderModule module = VK_NULL_HANDLE;
    check(vkCreateShaderModule(device, &info, nullptr, &module), "Loading a shader");
    return {device, module, vkDestroyShaderModule};
}

Handle<VkPipeline> createPipeline(VkDevice device, VkRenderPass renderPass, VkPipelineLayout layout) {
    const auto vertex = shaderModule(device, Present_vert);
    const auto fragment = shaderModule(device, Present_frag);
    std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
    for (VkPipelineShaderStageCreateInfo& stage : stages) {
        stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        stage.pName = "main";
    }
    stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
    stages[0].module = vertex.get();
    stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
    stages[1].module = fragment.get();

    const VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = 1;
    viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.polygonMode = VK_POLYGON_MODE_FILL;
    raster.lineWidth = 1;
    VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineColorBlendAttachmentState attachment{};
    attachment.colorWriteMask =
        VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = 1;
    blend.pAttachments = &attachment;
    const std::array dynamic{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamicState{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamicState.dynamicStateCount = static_cast<std::uint32_t>(dynamic.size());
    dynamicState.pDynamicStates = dynamic.data();

    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
    info.stageCount = static_cast<std::uint32_t>(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamicState;
    info.layout = layout;
    info.renderPass = renderPass;
    VkPipeline pipeline = VK_NULL_HANDLE;
    check(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), "Creating a pipeline");
    return {device, pipeline, vkDestroyPipeline};
}

// Every n-th pixel of every n-th row.
void copyReduced(const image::Image& image, std::uint32_t n, float* to) {
    for (std::uint32_t y = 0; y + n <= image.height; y += n) {
        for (std::uint32_t x = 0; x + n <= image.width; x += n, to += 3) std::memcpy(to, image.pixel(x, y), 12);
    }
}

} // namespace

FilmPass::FilmPass(GraphicsDevice& device, VkRenderPass renderPass) : device_(device) {
    std::array<VkDescriptorSetLayoutBinding, 2> bindings{};
    for (std::uint32_t i = 0; i < bindings.size(); ++i) {
        bindings[i].binding = i;
        bindings[i].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        bindings[i].descriptorCount = 1;
        bindings[i].stageFlags = VK_SHADER_STAGE_FRAGMENT_BIT;
    }
    VkDescriptorSetLayoutCreateInfo setInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    setInfo.bindingCount = static_cast<std::uint32_t>(bindings.size());
    setInfo.pBindings = bindings.data();
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    check(vkCreateDescriptorSetLayout(device.device(), &setInfo, nullptr, &setLayout), "Creating a descriptor layout");
    setLayout_ = {device.device(), setLayout, vkDestroyDescriptorSetLayout};

    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2};
    VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = 1;
    poolInfo.pPoolSizes = &size;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(device.device(), &poolInfo, nullptr, &pool), "Creating a descriptor pool");
    descriptorPool_ = {device.device(), pool, vkDestroyDescriptorPool};
    VkDescriptorSetAllocateInfo allocation{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocation.descriptorPool = pool;
    allocation.descriptorSetCount = 1;
    allocation.pSetLayouts = &setLayout;
    check(vkAllocateDescriptorSets(device.device(), &allocation, &set_), "Creating a descriptor set");

    const VkPushConstantRange range{VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(PresentConstants)};
    VkPipelineLayoutCreateInfo layoutInfo{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layoutInfo.setLayoutCount = 1;
    layoutInfo.pSetLayouts = &setLayout;
    layoutInfo.pushConstantRangeCount = 1;
    layoutInfo.pPushConstantRanges = &range;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    check(vkCreatePipelineLayout(device.device(), &layoutInfo, nullptr, &layout), "Creating a pipeline layout");
    layout_ = {device.device(), layout, vkDestroyPipelineLayout};
    pipeline_ = createPipeline(device.device(), renderPass, layout);
    for (std::size_t slot = 0; slot < images_.size(); ++slot) provide(slot, 12);
}

// A buffer of another size. What used the one before must be over.
void FilmPass::provide(std::size_t slot, VkDeviceSize bytes) {
    if (images_[slot].bytes() == bytes) return;
    check(vkDeviceWaitIdle(device_.device()), "Drawing on " + device_.name());
    images_[slot] = {};
    images_[slot] =
        GraphicsBuffer(device_, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                       VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    const VkDescriptorBufferInfo buffer{images_[slot].get(), 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = set_;
    write.dstBinding = static_cast<std::uint32_t>(slot);
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    write.pBufferInfo = &buffer;
    vkUpdateDescriptorSets(device_.device(), 1, &write, 0, nullptr);
}

void FilmPass::upload(VkCommandBuffer commands, std::uint32_t frame, Slot which, const image::Image& image) {
    const auto slot = static_cast<std::size_t>(which);
    std::uint32_t n = 1;
    while (VkDeviceSize{image.width / n} * (image.height / n) * 12 > device_.maxStorageBytes()) ++n;
    const std::uint32_t width = image.width / n, height = image.height / n;
    const VkDeviceSize bytes = VkDeviceSize{width} * height * 12;
    if (bytes == 0) return;
    provide(slot, bytes);
    GraphicsBuffer& staging = staging_[frame][slot];
    if (staging.bytes() != bytes) {
        staging = {};
        staging = GraphicsBuffer(device_, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, kMapped);
    }
    copyReduced(image, n, static_cast<float*>(staging.mapped()));
    sizes_[slot] = {width, height};
    if (which == Slot::Picture) reduction_ = n;

    VkMemoryBarrier before{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    before.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1, &before, 0, nullptr, 0, nullptr);
    const VkBufferCopy region{0, 0, bytes};
    vkCmdCopyBuffer(commands, staging.get(), images_[slot].get(), 1, &region);
    VkMemoryBarrier after{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    after.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    after.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0, 1, &after,
                         0, nullptr, 0, nullptr);
}

void FilmPass::draw(VkCommandBuffer commands, VkExtent2D extent, PresentConstants constants,
                    const VkRect2D& part) const {
    constants.width = sizes_[0][0];
    constants.height = sizes_[0][1];
    constants.scale *= static_cast<float>(reduction_);
    if (sizes_[1] != sizes_[0]) constants.split = -1; // a held image of another size cannot be compared
    const VkViewport viewport{0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.get());
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &part);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(), 0, 1, &set_, 0, nullptr);
    vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof constants, &constants);
    vkCmdDraw(commands, 3, 1, 0, 0);
}

} // namespace rt::gui
