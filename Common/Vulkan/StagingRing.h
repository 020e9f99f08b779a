// The way of data to and from the device's memory: through mapped memory of bounded size, whatever the size of the
// data.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <vulkan/vulkan.h>

#include "Common/Vulkan/Buffer.h"
#include "Common/Vulkan/Submission.h"
#include "Common/Vulkan/VulkanContext.h"

namespace rt::vulkan {

// Slots that pieces of uploads take turns in, so that the host fills one while the device copies from another:
//     host    fill 0 | fill 1 | fill 2 | fill 0 …   waits for the copy from a slot before it fills that again
//     device         | copy 0 | copy 1 | copy 2 …
class StagingRing {
  public:
    explicit StagingRing(VulkanContext& context);

    // Copies the data to bytes [offset, offset + data.size()) of the buffer, and waits for that. Throws DeviceLostError
    // or RenderError.
    void upload(const Buffer& to, std::span<const std::byte> data, VkDeviceSize offset);

  private:
    struct Slot {
        explicit Slot(VulkanContext& context);
        Run run;
        Buffer bytes;
        bool isBusy = false;
    };
    static void await(Slot& slot);

    VulkanContext& context_;
    std::array<Slot, 3> slots_;
    std::size_t next_ = 0;
};

// Through the context's ring.
void upload(VulkanContext& context, const Buffer& to, std::span<const std::byte> data, VkDeviceSize offset = 0);
// The way back, in pieces of the same bounded size. Waits.
void download(VulkanContext& context, const Buffer& from, std::span<std::byte> data, VkDeviceSize offset = 0);

// A device buffer with these contents; empty where there are none. Otherwise like Buffer().
template <class T>
Buffer deviceArray(VulkanContext& context, std::span<const T> data, const char* name, VkBufferUsageFlags usage = 0,
                   VkDeviceSize alignment = 1) {
    if (data.empty()) return {};
    Buffer buffer(context.memory(), data.size_bytes(), usage, Memory::Device, name, alignment);
    upload(context, buffer, std::as_bytes(data));
    return buffer;
}

} // namespace rt::vulkan
