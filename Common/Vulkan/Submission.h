// Commands of their own, which the device works at while the host goes on.
#pragma once
#include <chrono>
#include <functional>

#include <vulkan/vulkan.h>

#include "Common/Vulkan/Handle.h"

namespace rt::vulkan {

class VulkanContext;
using Record = std::function<void(VkCommandBuffer)>;

class Run {
  public:
    explicit Run(VulkanContext& context);
    ~Run(); // not while the device works at it
    Run(const Run&) = delete;
    Run& operator=(const Run&) = delete;

    // Records commands and hands them to the device, which takes them up when it is through with what it got before, if
    // that ends with a barrier. Throws DeviceLostError or RenderError.
    void begin(const Record& record);
    // Waits for their end, but for no more than a minute where it is not the CPU that works: not every system has a
    // watchdog for that. Throws DeviceLostError then. Returns how long the device took for it in seconds: by its own
    // clock if it has one.
    double finish();

  private:
    void requireDevice() const;
    void await();

    VulkanContext& context_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    Handle<VkFence> fence_;
    Handle<VkQueryPool> timestamps_;
    std::chrono::steady_clock::time_point begun_;
};

} // namespace rt::vulkan
