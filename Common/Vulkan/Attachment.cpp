#include "Common/Vulkan/Attachment.h"

#include "Common/Vulkan/Check.h"
#include "Common/Vulkan/Create.h"

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
    image_ = create(device, vkCreateImage, info, vkDestroyImage, what);

    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device, image(), &needs);
    memory_ = from.allocateAlone(needs, Memory::Device, what);
    check(vkBindImageMemory(device, image(), memory_.memory(), memory_.offset()), what);

    view_ = createView(device, image(), desc.format, desc.aspect, what);
}

} // namespace rt::vulkan
