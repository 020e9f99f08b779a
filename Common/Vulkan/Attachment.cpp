#include "Common/Vulkan/Attachment.h"

#include "Common/Vulkan/Check.h"

namespace rt::vulkan {

Attachment::Attachment(DeviceMemory& from, const AttachmentDesc& desc, const char* what) {
    const VkDevice device = from.device();
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = desc.format;
    info.extent = {desc.extent.width, desc.extent.height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = desc.samples;
    info.usage = desc.usage;
    VkImage image = VK_NULL_HANDLE;
    check(vkCreateImage(device, &info, nullptr, &image), what);
    image_ = {device, image, vkDestroyImage};

    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device, image, &needs);
    memory_ = from.allocateAlone(needs, Memory::Device, what);
    check(vkBindImageMemory(device, image, memory_.memory(), memory_.offset()), what);

    VkImageViewCreateInfo viewInfo{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    viewInfo.image = image;
    viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
    viewInfo.format = desc.format;
    viewInfo.subresourceRange = {desc.aspect, 0, 1, 0, 1};
    VkImageView view = VK_NULL_HANDLE;
    check(vkCreateImageView(device, &viewInfo, nullptr, &view), what);
    view_ = {device, view, vkDestroyImageView};
}

} // namespace rt::vulkan
