// A window of the operating system, by GLFW.
#pragma once
#include <array>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

#include "Common/Gui/InputQueue.h"

struct GLFWwindow;

namespace rt::gui {

struct WindowPlace {
    // In the window's units, as the size; without a position that is the size at a monitor's scale of 1.
    int x = 0, y = 0;
    int width = 1360, height = 860;
    bool hasPosition = false;
    bool maximised = false;
};

class Window {
  public:
    // Throws RenderError where there is no display, or no Vulkan that draws to one. One at a time, on the main thread.
    Window(const std::string& title, const WindowPlace& place);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    GLFWwindow* get() const { return window_; }
    static std::vector<const char*> instanceExtensions();
    // Throws RenderError.
    VkSurfaceKHR createSurface(VkInstance instance) const;

    bool shouldClose() const;
    void close();
    void stayOpen(); // after all, though it should close
    void hide();
    void setTitle(const std::string& title);
    // Handles what has happened; waits for it at most this long.
    void waitEvents(double seconds);
    // Since the last call: whether anything has come from the user, and whether the window is another or has to be
    // drawn anew.
    bool takeInput();
    bool takeChange();
    // What has come from keyboard and mouse and no frame has taken yet.
    bool hasEvents() const { return !events_.isEmpty(); }
    std::vector<InputEvent> takeEvents(bool isTyping);          // as InputQueue::take()
    bool isDown(int key) const { return down_.count(key) > 0; } // by the events that were taken

    // Pixels; 0 while minimised.
    std::array<int, 2> framebufferSize() const { return isMinimised_ ? std::array<int, 2>{} : pixels_; }
    // Both change when the window goes to another monitor, or that is set up anew.
    float pixelDensity() const; // pixels for one of the window's units, to 1/20
    float monitorScale() const; // how large things are to be, in the window's units: 1 for 96 of them per inch
    void toggleFullScreen();
    WindowPlace place() const; // as it is when it fills neither screen nor monitor

    void setClipboard(const std::string& text);
    std::string clipboard() const;
    // Is called with the paths of files that were dropped.
    void onDrop(std::function<void(std::vector<std::string>)> handler) { onDrop_ = std::move(handler); }

  private:
    void fitMonitor(const WindowPlace& place);
    void askForSizes();
    void listen();
    void note(const InputEvent& event);

    GLFWwindow* window_ = nullptr;
    // As events told them: to ask means to wait for a display server, which may have to wait for those who render.
    std::array<int, 2> size_{}, pixels_{};
    bool isMinimised_ = false;
    std::function<void(std::vector<std::string>)> onDrop_;
    InputQueue events_;
    std::set<int> down_; // keys
    bool input_ = false, change_ = true;
    bool fullScreen_ = false;
    WindowPlace restored_; // to go back to from full screen
};

} // namespace rt::gui
