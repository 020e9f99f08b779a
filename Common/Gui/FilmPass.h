// Draws a picture and, beside it, a held one: exposure, tone curve, sRGB.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include <vulkan/vulkan.h>

#include "Common/Gui/GraphicsDevice.h"
#include "Common/Image/Image.h"
#include "Common/Vulkan/Buffer.h"
#include "Common/Vulkan/Pipelines.h"

namespace rt::gui {

inline constexpr std::uint32_t kFramesInFlight = 2;

// Flags: that image is display intensities already; pixels that are enlarged run into each other;
// the difference of both images is shown.
inline constexpr std::uint32_t kPlainPicture = 1, kPlainHeld = 2, kSmooth = 4, kDifference = 8;

// As Constants of Shaders/Present.frag.
struct PresentConstants {
    float originX = 0, originY = 0; // of the image's upper left corner, in pixels of the window
    float scale = 1;                // pixels of the window for one of the image
    float exposure = 0;             // stops
    std::uint32_t width = 0, height = 0;
    std::uint32_t curve = 0;
    std::uint32_t flags = 0; // kPlainPicture and the like
    float split = -1;        // the held image is shown to the left of this; pixels of the window
    float surround[3] = {};
    bool operator==(const PresentConstants&) const = default;
};

class FilmPass {
  public:
    FilmPass(GraphicsDevice& device, VkRenderPass renderPass);

    enum class Slot { Picture, Held };
    // Takes the image to the device with the commands of frame `frame`, outside of a render pass. Three channels. Of an
    // image that is too large for the device only every n-th pixel is shown.
    void upload(VkCommandBuffer commands, std::uint32_t frame, Slot slot, const image::Image& image);
    // Within the render pass. The size in the constants is filled in.
    void draw(VkCommandBuffer commands, VkExtent2D extent, const PresentConstants& constants) const {
        draw(commands, extent, constants, {{0, 0}, extent});
    }
    void draw(VkCommandBuffer commands, VkExtent2D extent, PresentConstants constants, const VkRect2D& part) const;

    std::uint32_t reduction() const { return reduction_; } // pixels of the picture, a side, for one that is shown

  private:
    void provide(std::size_t slot, VkDeviceSize bytes);

    GraphicsDevice& device_;
    vulkan::DescriptorSet bindings_; // the images
    vulkan::Handle<VkPipelineLayout> layout_;
    vulkan::Handle<VkPipeline> pipeline_;
    std::array<vulkan::Buffer, 2> images_;                               // by slot
    std::array<std::array<vulkan::Buffer, 2>, kFramesInFlight> staging_; // by frame and slot
    std::array<std::array<std::uint32_t, 2>, 2> sizes_{};
    std::uint32_t reduction_ = 1;
};

} // namespace rt::gui
