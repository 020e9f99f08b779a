#include "Common/Gui/Snapshot.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "Common/Core/Error.h"
#include "Common/Gui/WindowRenderPass.h"
#include "Common/Image/Image.h"
#include "Common/Image/ImageIo.h"
#include "Common/Shared/Tonemap.h"
#include "Common/Vulkan/Attachment.h"
#include "Common/Vulkan/Barrier.h"
#include "Common/Vulkan/Buffer.h"
#include "Common/Vulkan/Check.h"
#include "Common/Vulkan/Create.h"

namespace rt::gui {
namespace {

using vulkan::check;
using vulkan::Handle;

constexpr const char* kDrawing = "Drawing a snapshot";

// An image to draw to, and to copy from afterwards.
class Target {
  public:
    Target(GraphicsDevice& device, VkFormat format, VkExtent2D extent)
        : extent_(extent),
          color_(device.memory(),
                 {format, extent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                  VK_IMAGE_ASPECT_COLOR_BIT},
                 kDrawing),
          renderPass_(makeWindowRenderPass(device.device(), format, VK_ATTACHMENT_LOAD_OP_CLEAR,
                                           VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL)) {
        const VkImageView view = color_.view();
        framebuffer_ = vulkan::createFramebuffer(device.device(), renderPass_.get(), {&view, 1}, extent, kDrawing);
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
        drawn.image = color_.image();
        drawn.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0,
                             0, nullptr, 0, nullptr, 1, &drawn);
        VkBufferImageCopy copy{};
        copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        copy.imageOffset = {part.offset.x, part.offset.y, 0};
        copy.imageExtent = {part.extent.width, part.extent.height, 1};
        vkCmdCopyImageToBuffer(commands, color_.image(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to, 1, &copy);
        vulkan::barrier(commands, vulkan::kTransferWrite, vulkan::kHostRead);
    }

  private:
    VkExtent2D extent_;
    vulkan::Attachment color_;
    Handle<VkRenderPass> renderPass_;
    Handle<VkFramebuffer> framebuffer_;
};

VkRect2D within(const Rect& part, VkExtent2D extent) {
    const auto side = [](float low, float length, std::uint32_t limit) {
        const float maximum = static_cast<float>(limit);
        const float from = std::clamp(std::floor(low), 0.0f, maximum - 1);
        const float to = std::clamp(std::ceil(low + length), from + 1, maximum);
        return std::pair{static_cast<std::int32_t>(from), static_cast<std::uint32_t>(to - from)};
    };
    const auto [x, width] = side(part.x, part.width, extent.width);
    const auto [y, height] = side(part.y, part.height, extent.height);
    return {{x, y}, {width, height}};
}

// The interface as an image: what ImGui has drawn, once more, to where it can be read. `part` of a target of `extent`
// pixels, in pixels, as linear display intensities.
image::Image takeSnapshot(GraphicsDevice& device, VkFormat format, VkExtent2D extent, const Rect& part,
                          const std::function<void(VkCommandBuffer)>& draw) {
    check(vkDeviceWaitIdle(device.device()), kDrawing); // what `draw` writes to may be in use
    const VkRect2D area = within(part, extent);
    image::Image picture(area.extent.width, area.extent.height);
    const Target target(device, format, extent);
    const vulkan::Buffer pixels(device.memory(), VkDeviceSize{picture.width} * picture.height * 4, 0,
                                vulkan::Memory::ReadBack, "a snapshot");
    device.run([&](VkCommandBuffer commands) { target.record(commands, area, pixels.get(), draw); });
    const bool isBgr = format == VK_FORMAT_B8G8R8A8_UNORM || format == VK_FORMAT_B8G8R8A8_SRGB;
    const std::span<const std::uint8_t> bytes = pixels.mapped<const std::uint8_t>();
    for (std::size_t i = 0; i < picture.data.size(); ++i) {
        const std::size_t channel = isBgr ? 2 - i % 3 : i % 3;
        picture.data[i] = shared::srgbDecode(static_cast<float>(bytes[i / 3 * 4 + channel]) / 255.0f);
    }
    return picture;
}

} // namespace

void savePart(Gui& gui, GraphicsDevice& device, VkFormat format, const std::function<void(VkCommandBuffer)>& draw) {
    const SavedPart saved = *std::exchange(gui.partToSave, std::nullopt);
    const std::string file = saved.file.string();
    const ImVec2 pixels = ImGui::GetIO().DisplayFramebufferScale, size = ImGui::GetIO().DisplaySize;
    const VkExtent2D extent{static_cast<std::uint32_t>(size.x * pixels.x),
                            static_cast<std::uint32_t>(size.y * pixels.y)};
    const Rect part{saved.part.x * pixels.x, saved.part.y * pixels.y, saved.part.width * pixels.x,
                    saved.part.height * pixels.y};
    try {
        image::writeImage(file, takeSnapshot(device, format, extent, part, draw));
        gui.say("Saved " + file);
    } catch (const Error& error) {
        gui.fail(error.what(), app::ErrorSource::Save);
    }
}

} // namespace rt::gui
