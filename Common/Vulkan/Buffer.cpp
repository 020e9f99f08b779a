#include "Common/Vulkan/VulkanResources.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "Common/Vulkan/Check.h"

namespace rt::vulkan {
namespace {

constexpr VkDeviceSize kStagingBytes = VkDeviceSize{64} << 20;

struct MemoryWish {
    VkMemoryPropertyFlags required;
    VkMemoryPropertyFlags preferred;
};

MemoryWish wish(Memory memory) {
    constexpr VkMemoryPropertyFlags kMapped =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    switch (memory) {
        case Memory::Upload:
            return {kMapped, 0};
        case Memory::ReadBack:
            return {kMapped, VK_MEMORY_PROPERTY_HOST_CACHED_BIT};
        case Memory::Device:
            break;
    }
    return {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
}

// Calls move(staging, offset in the data, bytes) for pieces of the data.
template <class Move>
void inPieces(VulkanContext& context, Memory memory, VkDeviceSize bytes, Move move) {
    if (bytes == 0) return;
    const Buffer staging(context, std::min(bytes, kStagingBytes), 0, memory, "transfers");
    for (VkDeviceSize done = 0; done < bytes; done += kStagingBytes) {
        move(staging, done, std::min(kStagingBytes, bytes - done));
    }
}

void copy(VulkanContext& context, VkBuffer from, VkBuffer to, const VkBufferCopy& region) {
    context.run([&](VkCommandBuffer commands) {
        vkCmdCopyBuffer(commands, from, to, 1, &region);
        barrier(commands);
    });
}

} // namespace

Buffer::Buffer(VulkanContext& context, VkDeviceSize bytes, VkBufferUsageFlags usage, Memory memory, const char* name)
    : context_(&context), bytes_(bytes) {
    const VkDevice device = context.device();
    const std::string what = std::string("Memory for ") + name + " (" + std::to_string(bytes) + " bytes)";
    if (bytes > context.limits().maxAllocation) {
        throw RenderError(what + ": more than the " + std::to_string(context.limits().maxAllocation) + " bytes that " +
                          context.info().name + " allows at a time");
    }
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = bytes;
    info.usage = usage | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                 VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    VkBuffer buffer = VK_NULL_HANDLE;
    check(vkCreateBuffer(device, &info, nullptr, &buffer), what);
    buffer_ = {device, buffer, vkDestroyBuffer};

    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device, buffer, &needs);
    const MemoryWish kind = wish(memory);
    VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo allocation{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &flags};
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex = context.memoryType(needs.memoryTypeBits, kind.required, kind.preferred);
    VkDeviceMemory storage = VK_NULL_HANDLE;
    check(vkAllocateMemory(device, &allocation, nullptr, &storage), what);
    memory_ = {device, storage, vkFreeMemory};
    check(vkBindBufferMemory(device, buffer, storage, 0), what);
    if (memory != Memory::Device) check(vkMapMemory(device, storage, 0, VK_WHOLE_SIZE, 0, &mapped_), what);

    VkBufferDeviceAddressInfo address{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
    address.buffer = buffer;
    address_ = vkGetBufferDeviceAddress(device, &address);
    if (memory == Memory::Device) allocated_ = needs.size;
    context.deviceBytes() += allocated_;
}

Buffer::~Buffer() {
    if (context_ != nullptr) context_->deviceBytes() -= allocated_;
    buffer_ = {};
}

void Buffer::swap(Buffer& other) noexcept {
    std::swap(context_, other.context_);
    std::swap(memory_, other.memory_);
    std::swap(buffer_, other.buffer_);
    std::swap(bytes_, other.bytes_);
    std::swap(allocated_, other.allocated_);
    std::swap(address_, other.address_);
    std::swap(mapped_, other.mapped_);
}

void upload(VulkanContext& context, const Buffer& to, std::span<const std::byte> data, VkDeviceSize offset) {
    inPieces(context, Memory::Upload, data.size(), [&](const Buffer& staging, VkDeviceSize at, VkDeviceSize bytes) {
        std::memcpy(staging.mapped<std::byte>().data(), data.data() + at, bytes);
        copy(context, staging.get(), to.get(), {0, offset + at, bytes});
    });
}

void download(VulkanContext& context, const Buffer& from, std::span<std::byte> data, VkDeviceSize offset) {
    inPieces(context, Memory::ReadBack, data.size(), [&](const Buffer& staging, VkDeviceSize at, VkDeviceSize bytes) {
        copy(context, from.get(), staging.get(), {offset + at, 0, bytes});
        std::memcpy(data.data() + at, staging.mapped<std::byte>().data(), bytes);
    });
}

} // namespace rt::vulkan
