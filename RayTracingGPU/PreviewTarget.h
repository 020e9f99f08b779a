// What the preview is drawn into: some rows of the image at a time, of several samples a pixel, each of four floats,
// with a depth buffer; and a buffer for the pixels of the whole image.
#pragma once
#include <cstdint>

#include "Common/Vulkan/Attachment.h"
#include "Common/Vulkan/Buffer.h"
#include "Common/Vulkan/VulkanContext.h"
#include "Shaders/Records.h"

namespace rt::gpu {

inline constexpr VkFormat kPreviewColor = VK_FORMAT_R32G32B32A32_SFLOAT;
inline constexpr VkSampleCountFlagBits kPreviewSampleBit = VK_SAMPLE_COUNT_4_BIT; // every device has it
static_assert(kPreviewSampleBit == shared::kPreviewSamples);

// Clears both attachments, or goes on with what a pass before has left in them; leaves the colours ready to be read by
// compute shaders.
vulkan::Handle<VkRenderPass> makePreviewRenderPass(VkDevice device, bool clears);

// Rows of the image.
struct Band {
    std::uint32_t first = 0, count = 0;
};

class PreviewTarget {
  public:
    PreviewTarget() = default;
    // For either of the render passes, and bands of at most so many rows. Throws RenderError where the device does not
    // draw such a large image.
    PreviewTarget(vulkan::VulkanContext& context, VkRenderPass renderPass, VkExtent2D extent, std::uint32_t bandRows);

    VkExtent2D extent() const { return extent_; }
    std::uint32_t bandRows() const { return band_.height; }
    VkImageView drawn() const { return color_.view(); }      // the band's samples
    const vulkan::Buffer& pixels() const { return pixels_; } // four floats each
    // Begins the render pass, with the viewport of the whole image and the band's part of it.
    void begin(VkCommandBuffer commands, VkRenderPass renderPass, const Band& band) const;

  private:
    VkExtent2D extent_{}, band_{};
    vulkan::Attachment color_, depth_;
    vulkan::Handle<VkFramebuffer> framebuffer_;
    vulkan::Buffer pixels_;
};

} // namespace rt::gpu
