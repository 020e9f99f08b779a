// Small pictures among the controls: those of a folder of the assets, such as of the built-in scenes. ImGui's renderer
// draws images of others only since 1.87, so a callback in its list of commands draws them.
#pragma once
#include <deque>
#include <future>
#include <map>
#include <string>

#include <imgui.h>
#include <vulkan/vulkan.h>

#include "Common/Gui/FilmPass.h"
#include "Common/Gui/GraphicsDevice.h"
#include "Common/Image/Image.h"

namespace rt::gui {

class Thumbnails {
  public:
    // Of all PNG files of the folder that have so many pixels on each side.
    Thumbnails(GraphicsDevice& device, VkRenderPass renderPass, const std::string& folder, std::uint32_t side);
    ~Thumbnails(); // waits for the device
    Thumbnails(const Thumbnails&) = delete;
    Thumbnails& operator=(const Thumbnails&) = delete;

    // Before each frame of ImGui. Files are read on another thread.
    void beginFrame();
    // Draws in the present window of ImGui, at a place in its units. False where there is no picture of that name.
    bool draw(const std::string& name, ImVec2 corner, float side);
    // With the commands of the frame, outside of a render pass: what has been read since.
    void upload(VkCommandBuffer commands);
    // The commands that ImGui's list is about to be turned into.
    void setCommands(VkCommandBuffer commands) { commands_ = commands; }

  private:
    // All that were found, one below the other.
    struct Sheet {
        image::Image image;
        std::map<std::string, std::uint32_t> places;
    };
    struct Tile {
        const Thumbnails* owner;
        std::uint32_t place;
        ImVec2 corner;
        float side;
    };
    static Sheet load(const std::string& folder, std::uint32_t side);
    void record(const Tile& tile, const ImVec4& clip) const;

    GraphicsDevice& device_;
    FilmPass pass_;
    const std::uint32_t side_; // pixels
    std::future<Sheet> loading_;
    std::map<std::string, std::uint32_t> places_;
    image::Image newSheet_;  // to be uploaded
    std::deque<Tile> tiles_; // of this frame; ImGui's list points to them
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

} // namespace rt::gui
