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

inline constexpr std::size_t kMaxViewports = 4;

// A picture, and the part of the window that shows it.
struct PicturePart {
    std::size_t slot = 0; // as in Presenter::setPicture()
    PresentConstants constants;
    VkRect2D part{}; // in pixels, within the window; of the first one all of the window
    bool operator==(const PicturePart& other) const;
};

struct WindowFrame {
    std::array<int, 2> size{};         // of the window, in pixels
    std::vector<PicturePart> pictures; // the first one with its surroundings covers everything, others lie over it
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

    // Are shown from the next frame on, of each viewport in a slot of its own, below kMaxViewports. The image must have
    // three channels.
    void setPicture(std::size_t slot, std::shared_ptr<const image::Image> picture);
    void setHeld(std::size_t slot, std::shared_ptr<const image::Image> held);
    void drop(std::size_t slot); // frees both; while no frame is under way

    // On the window's thread, before a frame: what the window system has taken away is replaced. Throws RenderError.
    void renew();
    // Shows a frame, on any thread; nothing where there is nothing to draw on, as while the window changes its size.
    // Throws RenderError or DeviceLostError.
    void present(const WindowFrame& frame);
    // Whether the window shows the frame's pictures, while no frame is under way.
    bool isShowing(const WindowFrame& frame) const;

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
    // Of a viewport, and what is to be uploaded.
    struct Shown {
        std::unique_ptr<FilmPass> film;
        std::shared_ptr<const image::Image> newPicture, newHeld;
    };
    FilmPass& filmOf(Shown& shown);
    void record(FrameSlot& slot, const SwapImage& target, const WindowFrame& frame);

    GraphicsDevice& device_;
    const Window& window_;
    VkSurfaceFormatKHR format_{};
    vulkan::Handle<VkRenderPass> renderPass_;
    std::array<Shown, kMaxViewports> shown_;
    std::array<FrameSlot, kFramesInFlight> slots_;
    std::uint32_t slot_ = 0;

    vulkan::Handle<VkSwapchainKHR> swapchain_;
    VkExtent2D extent_{};
    std::vector<SwapImage> images_;
    bool surfaceLost_ = false;
    std::array<int, 2> presentedSize_{}; // of the window that shows these pictures
    std::vector<PicturePart> presentedPictures_;
};

} // namespace rt::gui
