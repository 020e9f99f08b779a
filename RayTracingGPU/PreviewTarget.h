// What the preview is drawn into: an image of four floats a pixel, with a depth buffer, and the buffer that it is
// copied to.
#pragma once
#include <cstdint>

#include "Common/Vulkan/Attachment.h"
#include "Common/Vulkan/Buffer.h"
#include "Common/Vulkan/VulkanContext.h"

namespace rt::gpu {

inline constexpr VkFormat kPreviewColor = VK_FORMAT_R32G32B32A32_SFLOAT;

// Clears both attachments, or goes on with what a pass before has left in them; leaves the colours ready to be copied.
vulkan::Handle<VkRenderPass> makePreviewRenderPass(VkDevice device, bool clears);

// Rows of the image.
struct Band {
    std::uint32_t first = 0, count = 0;
};

class PreviewTarget {
  public:
    PreviewTarget() = default;
    // For either of the render passes. Throws RenderError where the device does not draw such a large image.
    PreviewTarget(vulkan::VulkanContext& context, VkRenderPass renderPass, VkExtent2D extent);

    VkExtent2D extent() const { return extent_; }
    const vulkan::Buffer& pixels() const { return pixels_; } // four floats each
    // Begins the render pass, with the viewport of the whole image and the band's part of it.
    void begin(VkCommandBuffer commands, VkRenderPass renderPass, const Band& band) const;
    // Copies what was drawn to pixels(), once the render pass has ended.
    void copy(VkCommandBuffer commands, const Band& band) const;

  private:
    VkExtent2D extent_{};
    vulkan::Attachment color_, depth_;
    vulkan::Handle<VkFramebuffer> framebuffer_;
    vulkan::Buffer pixels_;
};

} // namespace rt::gpu
