// Small pictures among the controls: those of a folder of the assets, such as of the built-in scenes.
#pragma once
#include <future>
#include <map>
#include <string>

#include <imgui.h>
#include <vulkan/vulkan.h>

#include "Common/Gui/GraphicsDevice.h"
#include "Common/Gui/PanelImage.h"
#include "Common/Image/Image.h"

namespace rt::gui {

class Thumbnails {
  public:
    // Of all PNG files of the folder that have so many pixels on each side.
    Thumbnails(GraphicsDevice& device, VkRenderPass renderPass, const std::string& folder, std::uint32_t side);

    // Before each frame of ImGui. Files are read on another thread.
    void beginFrame();
    // Draws in the present window of ImGui, at a place in its units. False where there is no picture of that name.
    bool draw(const std::string& name, ImVec2 corner, float side);
    // As those of PanelImage.
    bool takeChange() { return image_.takeChange(); }
    void upload(VkCommandBuffer commands, std::uint32_t frame) { image_.upload(commands, frame); }
    void setCommands(VkCommandBuffer commands) { image_.setCommands(commands); }

  private:
    // All that were found, one below the other.
    struct Sheet {
        image::Image image;
        std::map<std::string, std::uint32_t> places;
    };
    static Sheet load(const std::string& folder, std::uint32_t side);

    PanelImage image_;
    const std::uint32_t side_; // pixels
    std::future<Sheet> loading_;
    std::map<std::string, std::uint32_t> places_;
};

} // namespace rt::gui
