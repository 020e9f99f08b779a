// A buffer with its memory.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include <vulkan/vulkan.h>

#include "Common/Vulkan/DeviceMemory.h"
#include "Common/Vulkan/Handle.h"

namespace rt::vulkan {

// For storage and for copies from and to it; addressable by shaders where its device's memory is.
class Buffer {
  public:
    Buffer() = default;
    // `bytes` > 0. `usage` beyond storage, copies and addressing. `name` appears in errors. `alignment` of its address,
    // a power of two, where its usage needs more than the driver knows of: of instances, scratch, shader binding
    // tables. Throws RenderError when memory does not suffice.
    Buffer(DeviceMemory& from, VkDeviceSize bytes, VkBufferUsageFlags usage, Memory memory, const char* name,
           VkDeviceSize alignment = 1);
    Buffer(Buffer&& other) noexcept { swap(other); }
    Buffer& operator=(Buffer&& other) noexcept {
        Buffer(std::move(other)).swap(*this);
        return *this;
    }

    VkBuffer get() const { return buffer_.get(); }
    VkDeviceSize bytes() const { return bytes_; }
    VkDeviceAddress address() const { return address_; } // 0 where it has none
    explicit operator bool() const { return static_cast<bool>(buffer_); }
    // Its contents, not for Memory::Device.
    template <class T>
    std::span<T> mapped() const {
        return {reinterpret_cast<T*>(memory_.mapped()), static_cast<std::size_t>(bytes_ / sizeof(T))};
    }

  private:
    void swap(Buffer& other) noexcept;

    Allocation memory_; // outlives the buffer
    Handle<VkBuffer> buffer_;
    VkDeviceSize bytes_ = 0;
    VkDeviceAddress address_ = 0;
};

} // namespace rt::vulkan
