// An image among the controls. ImGui's renderer draws images of others only since 1.87, so a callback in its list of
// commands draws it.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>

#include <imgui.h>
#include <vulkan/vulkan.h>

#include "Common/Gui/FilmPass.h"
#include "Common/Gui/GraphicsDevice.h"
#include "Common/Image/Image.h"

namespace rt::gui {

class PanelImage {
  public:
    PanelImage(GraphicsDevice& device, VkRenderPass renderPass) : device_(device), pass_(device, renderPass) {}
    ~PanelImage(); // waits for the device
    PanelImage(const PanelImage&) = delete;
    PanelImage& operator=(const PanelImage&) = delete;

    // Linear, of three channels; is shown from the next frame on.
    void set(image::Image image) { newImage_ = std::move(image); }
    // Before each frame of ImGui.
    void beginFrame() { tiles_.clear(); }
    // Draws a part of the image in the present window of ImGui, at a place in its units: its whole width, which has
    // `pixels`, from the row `firstRow` on.
    void draw(const ImVec2& corner, const ImVec2& size, std::uint32_t pixels, std::uint32_t firstRow = 0);
    // Whether the frame draws otherwise than the one did of which this was asked before.
    bool takeChange();
    // With the commands of frame `frame`, outside of a render pass: the image, if it is a new one.
    void upload(VkCommandBuffer commands, std::uint32_t frame);
    // The commands that ImGui's list is about to be turned into.
    void setCommands(VkCommandBuffer commands) { commands_ = commands; }

  private:
    struct Tile {
        const PanelImage* owner;
        ImVec2 corner, size;
        std::uint32_t pixels, firstRow;
        bool operator==(const Tile& other) const;
    };
    void record(const Tile& tile, const ImVec4& clip) const;

    GraphicsDevice& device_;
    FilmPass pass_;
    std::optional<image::Image> newImage_; // to be uploaded
    std::deque<Tile> tiles_;               // of this frame; ImGui's list points to them
    std::deque<Tile> drawn_;               // of the frame before
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

} // namespace rt::gui
