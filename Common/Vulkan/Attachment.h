// An image that is drawn to.
#pragma once
#include <cstdint>
#include <functional>

#include <vulkan/vulkan.h>

#include "Common/Vulkan/Handle.h"

namespace rt::vulkan {

struct AttachmentDesc {
    VkFormat format;
    VkExtent2D extent;
    VkImageUsageFlags usage;
    VkImageAspectFlags aspect;
};

// With memory of its own.
class Attachment {
  public:
    Attachment() = default;
    // memoryType: chooses the device's own memory among the allowed types. Throws RenderError with `what`.
    Attachment(VkDevice device, const AttachmentDesc& desc,
               const std::function<std::uint32_t(std::uint32_t allowed)>& memoryType, const char* what);

    VkImage image() const { return image_.get(); }
    VkImageView view() const { return view_.get(); }

  private:
    Handle<VkDeviceMemory> memory_; // outlives the image
    Handle<VkImage> image_;
    Handle<VkImageView> view_;
};

} // namespace rt::vulkan
