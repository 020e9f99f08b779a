// The Vulkan instance and, with validation, the counter of its messages.
#pragma once
#include <atomic>
#include <cstdint>
#include <vector>

#include <vulkan/vulkan.h>

namespace rt::vulkan {

inline constexpr std::uint32_t kApiVersion = VK_API_VERSION_1_2;

class Instance {
  public:
    // With validation the Khronos validation layer checks every call, synchronization included; its messages are logged
    // and counted. Throws NoDeviceError where there is no driver at all, RenderError where the layer is not installed.
    // `extensions` are enabled besides, such as those of a window system.
    explicit Instance(bool validation, std::vector<const char*> extensions = {});
    ~Instance();
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;

    VkInstance get() const { return instance_; }
    std::uint64_t validationMessages() const { return messages_.load(std::memory_order_relaxed); }
    // Of all instances of the process, also those that are gone with what they had to say of their end.
    static std::uint64_t allValidationMessages();
    // Leaves the instance to the operating system: to end it would wait for a device that does not answer.
    void abandon() {
        instance_ = VK_NULL_HANDLE;
        messenger_ = VK_NULL_HANDLE;
    }

  private:
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    std::atomic<std::uint64_t> messages_{0};
};

} // namespace rt::vulkan
