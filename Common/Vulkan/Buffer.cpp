#include "Common/Vulkan/Buffer.h"

#include <algorithm>
#include <string>

#include "Common/Vulkan/Check.h"
#include "Common/Vulkan/Create.h"

namespace rt::vulkan {

Buffer::Buffer(DeviceMemory& from, VkDeviceSize bytes, VkBufferUsageFlags usage, Memory memory, const char* name,
               VkDeviceSize alignment)
    : bytes_(bytes) {
    const VkDevice device = from.device();
    const std::string what = std::string("Memory for ") + name + " (" + std::to_string(bytes) + " bytes)";
    if (bytes > from.largest()) {
        throw RenderError(what + ": more than the " + std::to_string(from.largest()) + " bytes that " +
                          from.deviceName() + " allows at a time");
    }
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = bytes;
    info.usage = usage | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                 VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    if (from.isAddressable()) info.usage |= VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    buffer_ = create(device, vkCreateBuffer, info, vkDestroyBuffer, what);

    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device, buffer_.get(), &needs);
    needs.alignment = std::max(needs.alignment, alignment);
    memory_ = from.allocate(needs, memory, what);
    check(vkBindBufferMemory(device, buffer_.get(), memory_.memory(), memory_.offset()), what);
    if (!from.isAddressable()) return;

    VkBufferDeviceAddressInfo address{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
    address.buffer = buffer_.get();
    address_ = vkGetBufferDeviceAddress(device, &address);
}

void Buffer::swap(Buffer& other) noexcept {
    std::swap(memory_, other.memory_);
    std::swap(buffer_, other.buffer_);
    std::swap(bytes_, other.bytes_);
    std::swap(address_, other.address_);
}

} // namespace rt::vulkan
