#include "Common/Gui/Snapshot.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "Common/Shared/Tonemap.h"
#include "Common/Vulkan/Check.h"

namespace rt::gui {
namespace {

using vulkan::check;
using vulkan::Handle;

constexpr VkMemoryPropertyFlags kReadable = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;

// An image to draw to, and to copy from afterwards.
class Target {
  public:
    Target(GraphicsDevice& device, VkFormat format, VkExtent2D extent) : extent_(extent) {
        createImage(device, format);
        createRenderPass(device.device(), format);
        VkFramebufferCreateInfo info{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
        const VkImageView view = view_.get();
        info.renderPass = renderPass_.get();
        info.attachmentCount = 1;
        info.pAttachments = &view;
        info.width = extent.width;
        info.height = extent.height;
        info.layers = 1;
        VkFramebuffer framebuffer = VK_NULL_HANDLE;
        check(vkCreateFramebuffer(device.device(), &info, nullptr, &framebuffer), "Drawing a snapshot");
        framebuffer_ = {device.device(), framebuffer, vkDestroyFramebuffer};
    }

    void record(VkCommandBuffer commands, const VkRect2D& part, VkBuffer to,
                const std::function<void(VkCommandBuffer)>& draw) const {
        const VkClearValue black{};
        VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
        begin.renderPass = renderPass_.get();
        begin.framebuffer = framebuffer_.get();
        begin.renderArea.extent = extent_;
        begin.clearValueCount = 1;
        begin.pClearValues = &black;
        vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
        draw(commands);
        vkCmdEndRenderPass(commands);
        VkImageMemoryBarrier drawn{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
        drawn.srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
        drawn.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
        drawn.oldLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        drawn.newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
        drawn.srcQueueFamilyIndex = drawn.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        drawn.image = image_.get();
        drawn.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0,
                             0, nullptr, 0, nullptr, 1, &drawn);
        VkBufferImageCopy copy{};
        copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        copy.imageOffset = {part.offset.x, part.offset.y, 0};
        copy.imageExtent = {part.extent.width, part.extent.height, 1};
        vkCmdCopyImageToBuffer(commands, image_.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to, 1, &copy);
        VkMemoryBarrier written{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
        written.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        written.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &written, 0,
                             nullptr, 0, nullptr);
    }

  private:
    void createImage(GraphicsDevice& device, VkFormat format) {
        VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
        info.imageType = VK_IMAGE_TYPE_2D;
        info.format = format;
        info.extent = {extent_.width, extent_.height, 1};
        info.mipLevels = info.arrayLayers = 1;
        info.samples = VK_SAMPLE_COUNT_1_BIT;
        info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
        VkImage image = VK_NULL_HANDLE;
        check(vkCreateImage(device.device(), &info, nullptr, &image), "Drawing a snapshot");
        image_ = {device.device(), image, vkDestroyImage};
        VkMemoryRequirements needs{};
        vkGetImageMemoryRequirements(device.device(), image, &needs);
        VkMemoryAllocateInfo allocation{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
        allocation.allocationSize = needs.size;
        allocation.memoryTypeIndex = device.memoryType(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
        VkDeviceMemory memory = VK_NULL_HANDLE;
        check(vkAllocateMemory(device.device(), &allocation, nullptr, &memory), "Drawing a snapshot");
        memory_ = {device.device(), memory, vkFreeMemory};
        check(vkBindImageMemory(device.device(), image, memory, 0), "Drawing a snapshot");
        VkImageViewCreateInfo viewInfo{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
        viewInfo.image = image;
        viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
        viewInfo.format = format;
        viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        VkImageView view = VK_NULL_HANDLE;
        check(vkCreateImageView(device.device(), &viewInfo, nullptr, &view), "Drawing a snapshot");
        view_ = {device.device(), view, vkDestroyImageView};
    }

    void createRenderPass(VkDevice device, VkFormat format) {
        VkAttachmentDescription attachment{};
        attachment.format = format;
        attachment.samples = VK_SAMPLE_COUNT_1_BIT;
        attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        attachment.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
        attachment.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
        attachment.finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
        VkSubpassDescription subpass{};
        subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
        subpass.colorAttachmentCount = 1;
        subpass.pColorAttachments = &reference;
        // As the presenter's: compatible render passes agree in that.
        VkSubpassDependency dependency{};
        dependency.srcSubpass = VK_SUBPASS_EXTERNAL;
        dependency.srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
        dependency.dstStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
        dependency.dstAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT;
        VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
        info.attachmentCount = 1;
        info.pAttachments = &attachment;
        info.subpassCount = 1;
        info.pSubpasses = &subpass;
        info.dependencyCount = 1;
        info.pDependencies = &dependency;
        VkRenderPass renderPass = VK_NULL_HANDLE;
        check(vkCreateRenderPass(device, &info, nullptr, &renderPass), "Drawing a snapshot");
        renderPass_ = {device, renderPass, vkDestroyRenderPass};
    }

    VkExtent2D extent_;
    Handle<VkDeviceMemory> memory_;
    Handle<VkImage> image_;
    Handle<VkImageView> view_;
    Handle<VkRenderPass> renderPass_;
    Handle<VkFramebuffer> framebuffer_;
};

VkRect2D within(const Rect& part, VkExtent2D extent) {
    const auto side = [](float low, float length, std::uint32_t limit) {
        const float most = static_cast<float>(limit);
        const float from = std::clamp(std::floor(low), 0.0f, most - 1);
        const float to = std::clamp(std::ceil(low + length), from + 1, most);
        return std::pair{static_cast<std::int32_t>(from), static_cast<std::uint32_t>(to - from)};
    };
    const auto [x, width] = side(part.x, part.width, extent.width);
    const auto [y, height] = side(part.y, part.height, extent.height);
    return {{x, y}, {width, height}};
}

} // namespace

image::Image takeSnapshot(GraphicsDevice& device, VkFormat format, VkExtent2D extent, const Rect& part,
                          const std::function<void(VkCommandBuffer)>& draw) {
    check(vkDeviceWaitIdle(device.device()), "Drawing a snapshot"); // what `draw` writes to may be in use
    const VkRect2D area = within(part, extent);
    image::Image picture(area.extent.width, area.extent.height);
    const Target target(device, format, extent);
    const GraphicsBuffer pixels(device, VkDeviceSize{picture.width} * picture.height * 4,
                                VK_BUFFER_USAGE_TRANSFER_DST_BIT, kReadable);
    device.run([&](VkCommandBuffer commands) { target.record(commands, area, pixels.get(), draw); });
    const bool isBgr = format == VK_FORMAT_B8G8R8A8_UNORM || format == VK_FORMAT_B8G8R8A8_SRGB;
    const auto* bytes = static_cast<const std::uint8_t*>(pixels.mapped());
    for (std::size_t i = 0; i < picture.data.size(); ++i) {
        const std::size_t channel = isBgr ? 2 - i % 3 : i % 3;
        picture.data[i] = shared::srgbDecode(static_cast<float>(bytes[i / 3 * 4 + channel]) / 255.0f);
    }
    return picture;
}

} // namespace rt::gui
