#include "Common/Vulkan/Attachment.h"

#include "Common/Vulkan/Check.h"

namespace rt::vulkan {

Attachment::Attachment(VkDevice device, const AttachmentDesc& desc,
                       const std::function<std::uint32_t(std::uint32_t allowed)>& memoryType, const char* what) {
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = desc.format;
    info.extent = {desc.extent.width, desc.extent.height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = desc.usage;
    VkImage image = VK_NULL_HANDLE;
    check(vkCreateImage(device, &info, nullptr, &image), what);
    image_ = {device, image, vkDestroyImage};

    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device, image, &needs);
    VkMemoryAllocateInfo allocation{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex = memoryType(needs.memoryTypeBits);
    VkDeviceMemory memory = VK_NULL_HANDLE;
    check(vkAllocateMemory(device, &allocation, nullptr, &memory), what);
    memory_ = {device, memory, vkFreeMemory};
    check(vkBindImageMemory(device, image, memory, 0), what);

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
