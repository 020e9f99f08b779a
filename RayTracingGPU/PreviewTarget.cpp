#include "RayTracingGPU/PreviewTarget.h"

#include <algorithm>
#include <array>
#include <string>

#include "Common/Vulkan/Create.h"

namespace rt::gpu {
namespace {

constexpr const char* kMakingTarget = "Preparing the preview";

} // namespace

vulkan::Handle<VkRenderPass> makePreviewRenderPass(VkDevice device, bool clears) {
    std::array<VkAttachmentDescription, 2> attachments{};
    for (VkAttachmentDescription& attachment : attachments) {
        attachment.samples = kPreviewSampleBit;
        attachment.loadOp = clears ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
        attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        attachment.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
        attachment.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    }
    attachments[0].format = kPreviewColor;
    attachments[0].finalLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    attachments[1].format = vulkan::kDepthFormat;
    attachments[1].finalLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    if (!clears) {
        for (VkAttachmentDescription& attachment : attachments) attachment.initialLayout = attachment.finalLayout;
    }
    const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &color;
    subpass.pDepthStencilAttachment = &depth;
    // Before: what was drawn to the attachments, and read of them. Behind: reading.
    constexpr VkPipelineStageFlags kDrawing = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                              VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                              VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    constexpr VkAccessFlags kWriting =
        VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    std::array<VkSubpassDependency, 2> dependencies{};
    dependencies[0] = {VK_SUBPASS_EXTERNAL,
                       0,
                       kDrawing | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                       kDrawing,
                       kWriting,
                       kWriting | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
                       0};
    dependencies[1] = {0,        VK_SUBPASS_EXTERNAL,       kDrawing, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                       kWriting, VK_ACCESS_SHADER_READ_BIT, 0};
    VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
    info.attachmentCount = static_cast<std::uint32_t>(attachments.size());
    info.pAttachments = attachments.data();
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    info.dependencyCount = static_cast<std::uint32_t>(dependencies.size());
    info.pDependencies = dependencies.data();
    return vulkan::create(device, vkCreateRenderPass, info, vkDestroyRenderPass, kMakingTarget);
}

PreviewTarget::PreviewTarget(vulkan::VulkanContext& context, VkRenderPass renderPass, VkExtent2D extent,
                             std::uint32_t bandRows)
    : extent_(extent), band_{extent.width, std::min(bandRows, extent.height)} {
    const std::uint32_t maximum = context.limits().maxDrawnSide;
    if (extent.width > maximum || extent.height > maximum) {
        throw RenderError("the preview of " + std::to_string(extent.width) + " x " + std::to_string(extent.height) +
                          " pixels: " + context.info().name + " draws at most " + std::to_string(maximum) + " a side");
    }
    color_ = {context.memory(),
              {kPreviewColor, band_, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
               VK_IMAGE_ASPECT_COLOR_BIT, kPreviewSampleBit},
              kMakingTarget};
    depth_ = {context.memory(),
              {vulkan::kDepthFormat, band_, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_IMAGE_ASPECT_DEPTH_BIT,
               kPreviewSampleBit},
              kMakingTarget};
    const std::array<VkImageView, 2> views{color_.view(), depth_.view()};
    framebuffer_ = vulkan::createFramebuffer(context.device(), renderPass, views, band_, kMakingTarget);
    const VkDeviceSize bytes = VkDeviceSize{extent.width} * extent.height * 4 * sizeof(float);
    pixels_ = vulkan::Buffer(context.memory(), bytes, 0, vulkan::Memory::Device, "the preview");
}

void PreviewTarget::begin(VkCommandBuffer commands, VkRenderPass renderPass, const Band& band) const {
    const std::array<VkClearValue, 2> zero{}; // nothing drawn, infinitely far
    VkRenderPassBeginInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    info.renderPass = renderPass;
    info.framebuffer = framebuffer_.get();
    info.renderArea = {{0, 0}, {extent_.width, band.count}};
    info.clearValueCount = static_cast<std::uint32_t>(zero.size());
    info.pClearValues = zero.data();
    vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
    const VkViewport viewport{
        0, -static_cast<float>(band.first), static_cast<float>(extent_.width), static_cast<float>(extent_.height), 0,
        1};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &info.renderArea);
}

} // namespace rt::gpu
