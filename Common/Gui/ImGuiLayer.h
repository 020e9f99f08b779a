// Dear ImGui in a window. What differs between its versions is in the source of this file and nowhere else.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include <imgui.h>
#include <vulkan/vulkan.h>

#include "Common/App/Interactive/GuiSettings.h"
#include "Common/Gui/GraphicsDevice.h"
#include "Common/Gui/InputFeed.h"
#include "Common/Gui/Layout.h"
#include "Common/Gui/Window.h"

namespace rt::gui {

struct Style {
    app::ColorMode colorMode = app::ColorMode::Dark;
    float scale = 1;   // of the interface, in the window's units
    float density = 1; // pixels for one of them
    std::string font;
    bool operator==(const Style&) const = default;
};

// Between two frames. A popup that has been opened but not drawn yet, as a table's menu is a frame later, has no
// window; where Escape is to close it, ImGui (1.86 to 1.92 at least) reads the window all the same and ends the
// program. `input`: as for ImGuiLayer::beginFrame.
void closeUndrawnPopups(std::span<const InputEvent> input);

// A window that can be docked, by its title, and where it is until the user moves it.
struct DockedWindow {
    enum class Place { Header, First, Side, Bottom }; // First: at the side, below the header
    const char* title;
    Place place;
};

// Of the space that windows dock in, until the user divides it otherwise.
struct DockShares {
    float side, header, first, bottom; // header: of the side; first: of what the header leaves of it
};

extern const ImGuiWindowFlags kNeverDocks; // of windows with a place of their own

// Shows the space of docked windows in `area`, before those; returns the part that none of them takes. None where
// ImGui does not dock.
std::optional<Rect> showDockSpace(const Rect& area, const DockShares& shares, std::span<const DockedWindow> windows);

class ImGuiLayer {
  public:
    // `layoutFile` keeps the layout; empty: nowhere.
    ImGuiLayer(const Window& window, GraphicsDevice& device, VkRenderPass renderPass, std::uint32_t imageCount,
               const std::filesystem::path& layoutFile);
    ~ImGuiLayer();
    ImGuiLayer(const ImGuiLayer&) = delete;
    ImGuiLayer& operator=(const ImGuiLayer&) = delete;

    void setStyle(const Style& style); // takes effect at the next beginFrame; costs nothing when it is the same
    float scale() const { return style_.scale; }
    // `input`: what has happened, as much of it as a frame may take (InputQueue).
    void beginFrame(std::span<const InputEvent> input);
    void dropFrame(); // instead of endFrame(): it has only taken input, and is not shown
    void endFrame();
    void draw(VkCommandBuffer commands); // what endFrame left
    // Whether that may differ from what it was when this was asked before, but for what callbacks draw.
    bool takeChange();

  private:
    void startRenderer();
    void applyStyle();

    GLFWwindow* window_;
    GraphicsDevice& device_;
    VkRenderPass renderPass_;
    std::uint32_t imageCount_;
    vulkan::Handle<VkDescriptorPool> descriptorPool_;
    std::string layoutFile_; // ImGui keeps a pointer to it
    Style style_;
    Style wanted_;
    bool started_ = false;
    InputFeed feed_;
    std::string drawn_; // bytes of all that the renderer draws by
};

} // namespace rt::gui
