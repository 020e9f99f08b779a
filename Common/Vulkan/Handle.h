// Ownership of Vulkan objects and devices.
#pragma once
#include <atomic>
#include <memory>
#include <utility>

#include <vulkan/vulkan.h>

namespace rt::vulkan {

// Devices that were lost or do not answer. What they have is left to the operating system: drivers have been seen to
// block or to crash when asked to free it. Neither are these records freed; any thread may add one.
struct AbandonedDevice {
    VkDevice device;
    const AbandonedDevice* next;
};
inline std::atomic<const AbandonedDevice*> abandonedDevices{nullptr};

inline void abandon(VkDevice device) {
    auto* added = new AbandonedDevice{device, abandonedDevices.load()};
    while (!abandonedDevices.compare_exchange_weak(added->next, added)) {
    }
}
inline bool isAbandoned(VkDevice device) {
    const AbandonedDevice* one = abandonedDevices.load();
    while (one != nullptr && one->device != device) one = one->next;
    return one != nullptr;
}

struct DestroyDevice {
    void operator()(VkDevice device) const {
        if (!isAbandoned(device)) vkDestroyDevice(device, nullptr);
    }
};
using OwnedDevice = std::unique_ptr<VkDevice_T, DestroyDevice>; // VkDevice is a pointer to that

// Destroys the object with its device's function, unless empty or of an abandoned device.
template <class T>
class Handle {
  public:
    using Destroy = void(VKAPI_PTR*)(VkDevice, T, const VkAllocationCallbacks*);

    Handle() = default;
    Handle(VkDevice device, T object, Destroy destroy) : device_(device), object_(object), destroy_(destroy) {}
    Handle(Handle&& other) noexcept { swap(other); }
    Handle& operator=(Handle&& other) noexcept {
        Handle(std::move(other)).swap(*this);
        return *this;
    }
    ~Handle() {
        if (object_ != T{} && !isAbandoned(device_)) destroy_(device_, object_, nullptr);
    }

    T get() const { return object_; }
    explicit operator bool() const { return object_ != T{}; }

  private:
    void swap(Handle& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(object_, other.object_);
        std::swap(destroy_, other.destroy_);
    }

    VkDevice device_ = VK_NULL_HANDLE;
    T object_ = T{};
    Destroy destroy_ = nullptr;
};

} // namespace rt::vulkan
