#include "Common/Gui/Window.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "Common/App/Platform.h"
#include "Common/Core/Error.h"
#include "Common/Vulkan/Check.h"

namespace rt::gui {
namespace {

std::string lastError() {
    const char* description = nullptr;
    glfwGetError(&description);
    return description != nullptr ? description : "unknown reason";
}

Window& self(GLFWwindow* window) {
    return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

// Where a stored position is no longer on any monitor, the system chooses.
bool isOnAMonitor(const WindowPlace& place) {
    int count = 0;
    GLFWmonitor** monitors = glfwGetMonitors(&count);
    for (int i = 0; i < count; ++i) {
        int x = 0, y = 0, width = 0, height = 0;
        glfwGetMonitorWorkarea(monitors[i], &x, &y, &width, &height);
        if (place.x >= x - 50 && place.x < x + width - 50 && place.y >= y - 50 && place.y < y + height - 50)
            return true;
    }
    return false;
}

} // namespace

Window::Window(const std::string& title, const WindowPlace& place) {
    // Libraries below would say so in their own words, besides.
    if (!app::hasDisplay())
        throw RenderError(
            "no window can be opened: DISPLAY and WAYLAND_DISPLAY are not set; "
            "--headless renders without one");
    if (glfwInit() != GLFW_TRUE)
        throw RenderError("no window can be opened: " + lastError() + "; --headless renders without one");
    if (glfwVulkanSupported() != GLFW_TRUE) {
        glfwTerminate();
        throw RenderError("no window can be opened: no Vulkan driver draws to windows; --headless renders without one");
    }
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    window_ = glfwCreateWindow(std::max(place.width, 1), std::max(place.height, 1), title.c_str(), nullptr, nullptr);
    if (window_ == nullptr) {
        const std::string reason = lastError();
        glfwTerminate();
        throw RenderError("no window can be opened: " + reason + "; --headless renders without one");
    }
    glfwSetWindowUserPointer(window_, this);
    askForSizes();
    if (!place.hasPosition) fitMonitor(place);
    if (place.hasPosition && isOnAMonitor(place)) glfwSetWindowPos(window_, place.x, place.y);
    if (place.maximised) glfwMaximizeWindow(window_);

    listen();
    glfwShowWindow(window_);
    askForSizes();
}

void Window::note(const InputEvent& event) {
    input_ = true;
    events_.push(event);
}

void Window::listen() {
    using Kind = InputEvent::Kind;
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int scancode, int action, int modifiers) {
        self(w).input_ = true;
        if (action != GLFW_REPEAT) self(w).note({Kind::Key, key, scancode, modifiers, action == GLFW_PRESS});
    });
    const auto onText = [](GLFWwindow* w, unsigned text) { self(w).note({Kind::Text, static_cast<int>(text)}); };
    const auto onEnter = [](GLFWwindow* w, int isIn) { self(w).note({Kind::Enter, 0, 0, 0, isIn == GLFW_TRUE}); };
    const auto onMove = [](GLFWwindow* w, double x, double y) { self(w).note({Kind::Move, 0, 0, 0, false, x, y}); };
    const auto onWheel = [](GLFWwindow* w, double x, double y) { self(w).note({Kind::Wheel, 0, 0, 0, false, x, y}); };
    glfwSetCharCallback(window_, onText);
    glfwSetCursorEnterCallback(window_, onEnter);
    glfwSetCursorPosCallback(window_, onMove);
    glfwSetScrollCallback(window_, onWheel);
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int modifiers) {
        self(w).note({Kind::Button, button, 0, modifiers, action == GLFW_PRESS});
    });
    glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int hasFocus) {
        self(w).events_.push({Kind::Focus, 0, 0, 0, hasFocus == GLFW_TRUE});
        self(w).change_ = true;
    });
    glfwSetWindowSizeCallback(window_, [](GLFWwindow* w, int width, int height) {
        self(w).size_ = {width, height};
        self(w).change_ = true;
    });
    glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int width, int height) {
        self(w).pixels_ = {width, height};
        self(w).change_ = true;
    });
    glfwSetWindowIconifyCallback(window_, [](GLFWwindow* w, int isMinimised) {
        self(w).isMinimised_ = isMinimised == GLFW_TRUE;
        self(w).change_ = true;
    });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { self(w).change_ = true; });
    glfwSetWindowContentScaleCallback(window_, [](GLFWwindow* w, float, float) { self(w).change_ = true; });
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
        self(w).input_ = true;
        if (self(w).onDrop_) self(w).onDrop_({paths, paths + count});
    });
}

void Window::askForSizes() {
    glfwGetWindowSize(window_, &size_[0], &size_[1]);
    glfwGetFramebufferSize(window_, &pixels_[0], &pixels_[1]);
}

// The first time: as much of the interface is seen on any monitor, if that is large enough.
void Window::fitMonitor(const WindowPlace& place) {
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    if (monitor == nullptr) return;
    int x = 0, y = 0, width = 0, height = 0;
    glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
    const auto fit = [scale = monitorScale()](int length, int maximum) {
        return std::max(1, std::min(static_cast<int>(std::lround(scale * static_cast<float>(length))), maximum));
    };
    glfwSetWindowSize(window_, fit(place.width, width), fit(place.height, height));
}

Window::~Window() {
    glfwDestroyWindow(window_);
    glfwTerminate();
}

std::vector<const char*> Window::instanceExtensions() {
    std::uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    return {names, names + count};
}

VkSurfaceKHR Window::createSurface(VkInstance instance) const {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    vulkan::check(glfwCreateWindowSurface(instance, window_, nullptr, &surface), "Drawing to the window");
    return surface;
}

bool Window::shouldClose() const {
    return glfwWindowShouldClose(window_) == GLFW_TRUE;
}
void Window::close() {
    glfwSetWindowShouldClose(window_, GLFW_TRUE);
}
void Window::stayOpen() {
    glfwSetWindowShouldClose(window_, GLFW_FALSE);
}
void Window::hide() {
    glfwHideWindow(window_);
}
void Window::setTitle(const std::string& title) {
    glfwSetWindowTitle(window_, title.c_str());
}

void Window::waitEvents(double seconds) {
    if (seconds <= 0)
        glfwPollEvents();
    else
        glfwWaitEventsTimeout(seconds);
}
bool Window::takeInput() {
    return std::exchange(input_, false);
}
bool Window::takeChange() {
    return std::exchange(change_, false);
}

std::vector<InputEvent> Window::takeEvents(bool isTyping) {
    std::vector<InputEvent> portion = events_.take(isTyping);
    for (const InputEvent& event : portion) {
        if (event.kind != InputEvent::Kind::Key) continue;
        if (event.isDown)
            down_.insert(event.code);
        else
            down_.erase(event.code);
    }
    return portion;
}

float Window::pixelDensity() const {
    constexpr float kSteps = 20; // a size in pixels is rounded, and fonts are not to be drawn anew with each of them
    const int width = size_[0], pixels = framebufferSize()[0];
    if (width <= 0 || pixels <= 0) return 1;
    return std::max(1.0f, std::round(kSteps * static_cast<float>(pixels) / static_cast<float>(width))) / kSteps;
}

float Window::monitorScale() const {
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    return x > 0 ? x / pixelDensity() : 1.0f;
}

WindowPlace Window::place() const {
    if (fullScreen_) return restored_;
    WindowPlace place;
    glfwGetWindowPos(window_, &place.x, &place.y);
    glfwGetWindowSize(window_, &place.width, &place.height);
    place.hasPosition = true;
    place.maximised = glfwGetWindowAttrib(window_, GLFW_MAXIMIZED) == GLFW_TRUE;
    return place;
}

void Window::toggleFullScreen() {
    if (fullScreen_) {
        glfwSetWindowMonitor(window_, nullptr, restored_.x, restored_.y, restored_.width, restored_.height, 0);
        fullScreen_ = false;
        return;
    }
    // The monitor that shows the middle of the window.
    const WindowPlace now = place();
    const int middleX = now.x + now.width / 2, middleY = now.y + now.height / 2;
    int count = 0;
    GLFWmonitor** monitors = glfwGetMonitors(&count);
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    for (int i = 0; i < count; ++i) {
        int x = 0, y = 0;
        glfwGetMonitorPos(monitors[i], &x, &y);
        const GLFWvidmode* mode = glfwGetVideoMode(monitors[i]);
        if (mode == nullptr) continue;
        if (middleX >= x && middleX < x + mode->width && middleY >= y && middleY < y + mode->height) {
            monitor = monitors[i];
        }
    }
    const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
    if (mode == nullptr) return;
    restored_ = now;
    glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
    fullScreen_ = true;
}

void Window::setClipboard(const std::string& text) {
    glfwSetClipboardString(window_, text.c_str());
}
std::string Window::clipboard() const {
    const char* text = glfwGetClipboardString(window_);
    return text != nullptr ? text : "";
}

} // namespace rt::gui
