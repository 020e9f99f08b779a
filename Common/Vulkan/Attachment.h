// An image that is drawn to.
#pragma once
#include <vulkan/vulkan.h>

#include "Common/Vulkan/DeviceMemory.h"
#include "Common/Vulkan/Handle.h"

namespace rt::vulkan {

struct AttachmentDesc {
    VkFormat format;
    VkExtent2D extent;
    VkImageUsageFlags usage;
    VkImageAspectFlags aspect;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
};

class Attachment {
  public:
    Attachment() = default;
    // In the device's own memory. Throws RenderError with `what`.
    Attachment(DeviceMemory& from, const AttachmentDesc& desc, const char* what);

    VkImage image() const { return image_.get(); }
    VkImageView view() const { return view_.get(); }

  private:
    Allocation memory_; // outlives the image
    Handle<VkImage> image_;
    Handle<VkImageView> view_;
};

} // namespace rt::vulkan
