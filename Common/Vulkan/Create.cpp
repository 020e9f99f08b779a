#include "Common/Vulkan/Create.h"

#include <cstdint>

namespace rt::vulkan {

Handle<VkFramebuffer> createFramebuffer(VkDevice device, VkRenderPass renderPass, std::span<const VkImageView> views,
                                        VkExtent2D extent, const char* what) {
    VkFramebufferCreateInfo info{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
    info.renderPass = renderPass;
    info.attachmentCount = static_cast<std::uint32_t>(views.size());
    info.pAttachments = views.data();
    info.width = extent.width;
    info.height = extent.height;
    info.layers = 1;
    return create(device, vkCreateFramebuffer, info, vkDestroyFramebuffer, what);
}

Handle<VkImageView> createView(VkDevice device, VkImage image, VkFormat format, VkImageAspectFlags aspect,
                               const char* what) {
    VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    info.image = image;
    info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    info.format = format;
    info.subresourceRange = {aspect, 0, 1, 0, 1};
    return create(device, vkCreateImageView, info, vkDestroyImageView, what);
}

} // namespace rt::vulkan
