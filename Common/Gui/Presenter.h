// The swapchain: pictures and user interface on the window, whatever becomes of its size and surface.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <vulkan/vulkan.h>

#include "Common/Gui/FilmPass.h"
#include "Common/Gui/GraphicsDevice.h"
#include "Common/Gui/Window.h"
#include "Common/Image/Image.h"

namespace rt::gui {

struct WindowFrame {
    std::array<int, 2> size{}; // of the window, in pixels
    PresentConstants constants;
    // Outside of the render pass, with the number of the frame in flight: what the interface needs.
    std::function<void(VkCommandBuffer, std::uint32_t)> upload;
    std::function<void(VkCommandBuffer)> drawInterface; // over the picture
};

class Presenter {
  public:
    Presenter(GraphicsDevice& device, const Window& window);
    ~Presenter();
    Presenter(const Presenter&) = delete;
    Presenter& operator=(const Presenter&) = delete;

    VkRenderPass renderPass() const { return renderPass_.get(); }
    VkFormat format() const { return format_.format; } // of the swapchain
    std::uint32_t imageCount() const { return static_cast<std::uint32_t>(images_.size()); }

    // Are shown from the next frame on. The image must have three channels.
    void setPicture(std::shared_ptr<const image::Image> picture);
    void setHeld(std::shared_ptr<const image::Image> held);

    // On the window's thread, before a frame: what the window system has taken away is replaced. Throws RenderError.
    void renew();
    // Shows a frame, on any thread; nothing where there is nothing to draw on, as while the window changes its size.
    // Throws RenderError or DeviceLostError.
    void present(const WindowFrame& frame);

  private:
    struct FrameSlot {
        vulkan::Handle<VkCommandPool> pool;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        vulkan::Handle<VkFence> done;
        vulkan::Handle<VkSemaphore> acquired;
    };
    struct SwapImage {
        VkImage image = VK_NULL_HANDLE;
        vulkan::Handle<VkImageView> view;
        vulkan::Handle<VkFramebuffer> framebuffer;
        vulkan::Handle<VkSemaphore> rendered;
    };

    void chooseFormat();
    void createSlots();
    bool provideSwapchain(const std::array<int, 2>& size);
    bool createSwapchain(const VkSurfaceCapabilitiesKHR& able, VkExtent2D extent);
    void dropSwapchain();
    void createImage(VkImage image, SwapImage& to);
    void record(FrameSlot& slot, const SwapImage& target, const WindowFrame& frame);

    GraphicsDevice& device_;
    const Window& window_;
    VkSurfaceFormatKHR format_{};
    vulkan::Handle<VkRenderPass> renderPass_;
    std::unique_ptr<FilmPass> film_;
    std::array<FrameSlot, kFramesInFlight> slots_;
    std::uint32_t slot_ = 0;

    vulkan::Handle<VkSwapchainKHR> swapchain_;
    VkExtent2D extent_{};
    std::vector<SwapImage> images_;
    bool surfaceLost_ = false;

    std::shared_ptr<const image::Image> newPicture_, newHeld_; // to be uploaded
};

} // namespace rt::gui
