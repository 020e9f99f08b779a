// Buffers with memory of their own, and the way of data to and from the device.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include <vulkan/vulkan.h>

#include "Common/Vulkan/VulkanContext.h"

namespace rt::vulkan {

enum class Memory {
    Device,   // fast for the device, not mapped
    Upload,   // mapped; the host writes, the device reads
    ReadBack, // mapped; the device writes, the host reads
};

// A buffer that is addressable by shaders and can be copied from and to.
class Buffer {
  public:
    Buffer() = default;
    // `usage` beyond addressing, storage and copies. `name` appears in errors. Throws RenderError when memory does not
    // suffice.
    Buffer(VulkanContext& context, VkDeviceSize bytes, VkBufferUsageFlags usage, Memory memory, const char* name);
    Buffer(Buffer&& other) noexcept { swap(other); }
    Buffer& operator=(Buffer&& other) noexcept {
        Buffer(std::move(other)).swap(*this);
        return *this;
    }
    ~Buffer();

    VkBuffer get() const { return buffer_.get(); }
    VkDeviceSize bytes() const { return bytes_; }
    VkDeviceAddress address() const { return address_; }
    explicit operator bool() const { return static_cast<bool>(buffer_); }
    // The mapped memory, not for Memory::Device.
    template <class T>
    std::span<T> mapped() const {
        return {static_cast<T*>(mapped_), static_cast<std::size_t>(bytes_ / sizeof(T))};
    }

  private:
    void swap(Buffer& other) noexcept;

    VulkanContext* context_ = nullptr;
    Handle<VkDeviceMemory> memory_; // outlives the buffer
    Handle<VkBuffer> buffer_;
    VkDeviceSize bytes_ = 0;
    VkDeviceSize allocated_ = 0;
    VkDeviceAddress address_ = 0;
    void* mapped_ = nullptr;
};

// Copies through a buffer of bounded size and waits.
void upload(VulkanContext& context, const Buffer& to, std::span<const std::byte> data, VkDeviceSize offset = 0);
void download(VulkanContext& context, const Buffer& from, std::span<std::byte> data, VkDeviceSize offset = 0);

// A device buffer with these contents; empty where there are none.
template <class T>
Buffer deviceArray(VulkanContext& context, std::span<const T> data, const char* name, VkBufferUsageFlags usage = 0) {
    if (data.empty()) return {};
    Buffer buffer(context, data.size_bytes(), usage, Memory::Device, name);
    upload(context, buffer, std::as_bytes(data));
    return buffer;
}

} // namespace rt::vulkan
