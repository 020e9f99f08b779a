#include "Common/Gui/Presenter.h"

#include <algorithm>
#include <limits>

#include "Common/Gui/WindowRenderPass.h"
#include "Common/Vulkan/Check.h"
#include "Common/Vulkan/Create.h"

namespace rt::gui {
namespace {

using vulkan::check;
using vulkan::Handle;

constexpr std::uint64_t kForever = std::numeric_limits<std::uint64_t>::max();

Handle<VkSemaphore> createSemaphore(VkDevice device) {
    const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    return vulkan::create(device, vkCreateSemaphore, info, vkDestroySemaphore, "Creating a semaphore");
}

} // namespace

bool PicturePart::operator==(const PicturePart& other) const {
    return slot == other.slot && constants == other.constants && part.offset.x == other.part.offset.x &&
           part.offset.y == other.part.offset.y && part.extent.width == other.part.extent.width &&
           part.extent.height == other.part.extent.height;
}

Presenter::Presenter(GraphicsDevice& device, const Window& window) : device_(device), window_(window) {
    chooseFormat();
    renderPass_ =
        makeWindowRenderPass(device.device(), format_.format,
                             VK_ATTACHMENT_LOAD_OP_DONT_CARE, // the picture and its surroundings cover everything
                             VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
    createSlots();
    filmOf(shown_.front());
    provideSwapchain(window.framebufferSize());
}

Presenter::~Presenter() {
    vkDeviceWaitIdle(device_.device());
}

// Bytes that are shown as they are: the shader and the interface encode sRGB themselves.
void Presenter::chooseFormat() {
    std::uint32_t count = 0;
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(device_.physicalDevice(), device_.surface(), &count, nullptr),
          "Asking for the window's formats");
    std::vector<VkSurfaceFormatKHR> formats(count);
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(device_.physicalDevice(), device_.surface(), &count, formats.data()),
          "Asking for the window's formats");
    if (formats.empty()) throw RenderError(device_.name() + " has no format for the window");
    format_ = formats.front();
    for (const VkFormat wanted : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM}) { // the last one found counts
        for (const VkSurfaceFormatKHR& format : formats) {
            if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) format_ = format;
        }
    }
}

void Presenter::createSlots() {
    const VkDevice device = device_.device();
    for (FrameSlot& slot : slots_) {
        VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
        poolInfo.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
        poolInfo.queueFamilyIndex = device_.queueFamily();
        slot.pool =
            vulkan::create(device, vkCreateCommandPool, poolInfo, vkDestroyCommandPool, "Creating a command pool");
        VkCommandBufferAllocateInfo allocation{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
        allocation.commandPool = slot.pool.get();
        allocation.commandBufferCount = 1;
        check(vkAllocateCommandBuffers(device, &allocation, &slot.commands), "Creating a command buffer");
        VkFenceCreateInfo fenceInfo{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        fenceInfo.flags = VK_FENCE_CREATE_SIGNALED_BIT;
        slot.done = vulkan::create(device, vkCreateFence, fenceInfo, vkDestroyFence, "Creating a fence");
        slot.acquired = createSemaphore(device);
    }
}

void Presenter::dropSwapchain() {
    vkDeviceWaitIdle(device_.device());
    images_.clear();
    swapchain_ = {};
    presentedSize_ = {};
    // An image may have been acquired without being drawn to: its semaphore cannot be used again.
    for (FrameSlot& slot : slots_) slot.acquired = createSemaphore(device_.device());
}

void Presenter::createImage(VkImage image, SwapImage& to) {
    const VkDevice device = device_.device();
    to.image = image;
    to.view = vulkan::createView(device, image, format_.format, VK_IMAGE_ASPECT_COLOR_BIT, "Drawing to the window");
    const VkImageView view = to.view.get();
    to.framebuffer = vulkan::createFramebuffer(device, renderPass_.get(), {&view, 1}, extent_, "Drawing to the window");
    to.rendered = createSemaphore(device);
}

void Presenter::renew() {
    if (!surfaceLost_) return;
    dropSwapchain();
    device_.renewSurface(window_);
    surfaceLost_ = false;
}

// False where the window has no area, or its surface is lost.
bool Presenter::provideSwapchain(const std::array<int, 2>& size) {
    const auto [width, height] = size;
    if (width <= 0 || height <= 0 || surfaceLost_) return false;
    const bool fits = swapchain_ && extent_.width == static_cast<std::uint32_t>(width) &&
                      extent_.height == static_cast<std::uint32_t>(height);
    if (fits) return true;

    VkSurfaceCapabilitiesKHR able{};
    const VkResult asked =
        vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physicalDevice(), device_.surface(), &able);
    if (asked == VK_ERROR_SURFACE_LOST_KHR) {
        surfaceLost_ = true;
        return false;
    }
    check(asked, "Asking for the window's size");
    VkExtent2D extent = able.currentExtent;
    if (extent.width == std::numeric_limits<std::uint32_t>::max()) {
        extent.width =
            std::clamp(static_cast<std::uint32_t>(width), able.minImageExtent.width, able.maxImageExtent.width);
        extent.height =
            std::clamp(static_cast<std::uint32_t>(height), able.minImageExtent.height, able.maxImageExtent.height);
    }
    if (extent.width == 0 || extent.height == 0) return false;
    // The window system may be ahead of or behind the window library: what the swapchain has is what counts.
    if (swapchain_ && extent_.width == extent.width && extent_.height == extent.height) return true;
    dropSwapchain();
    return createSwapchain(able, extent);
}

// False where the surface is lost.
bool Presenter::createSwapchain(const VkSurfaceCapabilitiesKHR& able, VkExtent2D extent) {
    VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    info.surface = device_.surface();
    info.minImageCount = std::max(able.minImageCount, 2u);
    if (able.maxImageCount > 0) info.minImageCount = std::min(info.minImageCount, able.maxImageCount);
    info.imageFormat = format_.format;
    info.imageColorSpace = format_.colorSpace;
    info.imageExtent = extent;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    info.imageSharingMode = VK_SHARING_MODE_EXCLUSIVE;
    info.preTransform = able.currentTransform;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    if ((able.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) == 0) {
        info.compositeAlpha = VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    }
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    info.clipped = VK_TRUE;
    VkSwapchainKHR swapchain = VK_NULL_HANDLE;
    const VkResult created = vkCreateSwapchainKHR(device_.device(), &info, nullptr, &swapchain);
    if (created == VK_ERROR_SURFACE_LOST_KHR || created == VK_ERROR_NATIVE_WINDOW_IN_USE_KHR) {
        surfaceLost_ = true;
        return false;
    }
    check(created, "Drawing to the window");
    swapchain_ = {device_.device(), swapchain, vkDestroySwapchainKHR};
    extent_ = extent;

    std::uint32_t count = 0;
    check(vkGetSwapchainImagesKHR(device_.device(), swapchain, &count, nullptr), "Drawing to the window");
    std::vector<VkImage> images(count);
    check(vkGetSwapchainImagesKHR(device_.device(), swapchain, &count, images.data()), "Drawing to the window");
    images_.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) createImage(images[i], images_[i]);
    return true;
}

void Presenter::setPicture(std::size_t slot, std::shared_ptr<const image::Image> picture) {
    shown_[slot].newPicture = std::move(picture);
}
void Presenter::setHeld(std::size_t slot, std::shared_ptr<const image::Image> held) {
    shown_[slot].newHeld = std::move(held);
}
void Presenter::drop(std::size_t slot) {
    if (shown_[slot].film) check(vkDeviceWaitIdle(device_.device()), "Drawing on " + device_.name());
    shown_[slot] = {};
    presentedSize_ = {};
}
FilmPass& Presenter::filmOf(Shown& shown) {
    if (!shown.film) shown.film = std::make_unique<FilmPass>(device_, renderPass_.get());
    return *shown.film;
}

bool Presenter::isShowing(const WindowFrame& frame) const {
    const auto isNew = [](const Shown& shown) { return shown.newPicture || shown.newHeld; };
    return frame.size == presentedSize_ && frame.pictures == presentedPictures_ &&
           std::none_of(shown_.begin(), shown_.end(), isNew);
}

void Presenter::present(const WindowFrame& frame) {
    presentedSize_ = {};
    if (!provideSwapchain(frame.size)) return;
    const VkDevice device = device_.device();
    FrameSlot& slot = slots_[slot_];
    const VkFence done = slot.done.get();
    check(vkWaitForFences(device, 1, &done, VK_TRUE, kForever), "Drawing on " + device_.name());

    std::uint32_t index = 0;
    const VkResult acquired =
        vkAcquireNextImageKHR(device, swapchain_.get(), kForever, slot.acquired.get(), VK_NULL_HANDLE, &index);
    if (acquired == VK_ERROR_SURFACE_LOST_KHR) surfaceLost_ = true;
    if (acquired == VK_ERROR_OUT_OF_DATE_KHR || acquired == VK_ERROR_SURFACE_LOST_KHR) {
        return dropSwapchain();
    }
    if (acquired != VK_SUBOPTIMAL_KHR) check(acquired, "Drawing to the window");

    const SwapImage& target = images_[index];
    record(slot, target, frame);
    check(vkResetFences(device, 1, &done), "Drawing on " + device_.name());
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    const VkSemaphore wait = slot.acquired.get();
    const VkSemaphore signal = target.rendered.get();
    VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    submit.waitSemaphoreCount = 1;
    submit.pWaitSemaphores = &wait;
    submit.pWaitDstStageMask = &stage;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &slot.commands;
    submit.signalSemaphoreCount = 1;
    submit.pSignalSemaphores = &signal;
    check(vkQueueSubmit(device_.queue(), 1, &submit, done), "Drawing on " + device_.name());

    VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    const VkSwapchainKHR swapchain = swapchain_.get();
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &signal;
    info.swapchainCount = 1;
    info.pSwapchains = &swapchain;
    info.pImageIndices = &index;
    const VkResult presented = vkQueuePresentKHR(device_.queue(), &info);
    slot_ = (slot_ + 1) % kFramesInFlight;
    if (presented == VK_ERROR_SURFACE_LOST_KHR) surfaceLost_ = true;
    if (presented == VK_ERROR_OUT_OF_DATE_KHR || presented == VK_SUBOPTIMAL_KHR ||
        presented == VK_ERROR_SURFACE_LOST_KHR) {
        dropSwapchain();
    } else {
        check(presented, "Drawing to the window");
        presentedSize_ = frame.size;
        presentedPictures_ = frame.pictures;
    }
}

void Presenter::record(FrameSlot& slot, const SwapImage& target, const WindowFrame& frame) {
    check(vkResetCommandPool(device_.device(), slot.pool.get(), 0), "Recording commands");
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(slot.commands, &begin), "Recording commands");
    for (Shown& shown : shown_) {
        if (shown.newPicture) filmOf(shown).upload(slot.commands, slot_, FilmPass::Slot::Picture, *shown.newPicture);
        if (shown.newHeld) filmOf(shown).upload(slot.commands, slot_, FilmPass::Slot::Held, *shown.newHeld);
        shown.newPicture = shown.newHeld = nullptr;
    }
    frame.upload(slot.commands, slot_);

    VkRenderPassBeginInfo pass{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    pass.renderPass = renderPass_.get();
    pass.framebuffer = target.framebuffer.get();
    pass.renderArea.extent = extent_;
    vkCmdBeginRenderPass(slot.commands, &pass, VK_SUBPASS_CONTENTS_INLINE);
    // The frame was laid out for a window that may have become smaller meanwhile.
    const auto within = [this](VkRect2D part) {
        part.offset.x = std::clamp(part.offset.x, 0, static_cast<std::int32_t>(extent_.width));
        part.offset.y = std::clamp(part.offset.y, 0, static_cast<std::int32_t>(extent_.height));
        part.extent.width = std::min(part.extent.width, extent_.width - static_cast<std::uint32_t>(part.offset.x));
        part.extent.height = std::min(part.extent.height, extent_.height - static_cast<std::uint32_t>(part.offset.y));
        return part;
    };
    for (const PicturePart& picture : frame.pictures) {
        const bool isFirst = &picture == &frame.pictures.front();
        const VkRect2D part = isFirst ? VkRect2D{{0, 0}, extent_} : within(picture.part);
        filmOf(shown_[picture.slot]).draw(slot.commands, extent_, picture.constants, part);
    }
    frame.drawInterface(slot.commands);
    vkCmdEndRenderPass(slot.commands);
    check(vkEndCommandBuffer(slot.commands), "Recording commands");
}

} // namespace rt::gui
