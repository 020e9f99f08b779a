// Ownership of one Vulkan object.
#pragma once
#include <atomic>
#include <utility>

#include <vulkan/vulkan.h>

namespace rt::vulkan {

// The last device that was lost or does not answer. What it has is left to the operating system: drivers have been seen to
// block or to crash when asked to free it.
inline std::atomic<VkDevice> abandonedDevice{VK_NULL_HANDLE};

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
        if (object_ != T{} && device_ != abandonedDevice) destroy_(device_, object_, nullptr);
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
