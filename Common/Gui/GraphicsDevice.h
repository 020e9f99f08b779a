// The device that draws the window: any Vulkan device that can, whether or not it traces rays. Engines have their own.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include <vulkan/vulkan.h>

#include "Common/Gui/Window.h"
#include "Common/Vulkan/DeviceMemory.h"
#include "Common/Vulkan/Handle.h"
#include "Common/Vulkan/Instance.h"

namespace rt::gui {

class GraphicsDevice {
  public:
    // Prefers the device with `preferred` in its name. Throws NoDeviceError where none can draw to the window.
    GraphicsDevice(const Window& window, bool validation, const std::string& preferred);
    ~GraphicsDevice();
    GraphicsDevice(const GraphicsDevice&) = delete;
    GraphicsDevice& operator=(const GraphicsDevice&) = delete;

    VkInstance instance() const { return instance_.get(); }
    VkPhysicalDevice physicalDevice() const { return physical_; }
    VkDevice device() const { return device_.get(); }
    vulkan::DeviceMemory& memory() { return *memory_; }
    VkQueue queue() const { return queue_; }
    std::uint32_t queueFamily() const { return queueFamily_; }
    VkSurfaceKHR surface() const { return surface_; }
    const std::string& name() const { return name_; }
    bool isSoftware() const { return isSoftware_; }
    VkDeviceSize maxStorageBytes() const { return maxStorageBytes_; }

    // After it was lost; nothing may use it any more. Throws RenderError where the device cannot draw to the new one.
    void renewSurface(const Window& window);
    // Runs commands and waits for them.
    void run(const std::function<void(VkCommandBuffer)>& record);

  private:
    void choose(const std::string& preferred);
    void createDevice();

    vulkan::Instance instance_;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    std::string name_;
    bool isSoftware_ = false;
    VkDeviceSize maxStorageBytes_ = 0;
    std::uint32_t queueFamily_ = 0;
    vulkan::OwnedDevice device_;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::optional<vulkan::DeviceMemory> memory_; // gone before the device
};

} // namespace rt::gui
