#include "Common/Vulkan/DeviceMemory.h"

#include <algorithm>

#include "Common/Vulkan/Check.h"

namespace rt::vulkan {
namespace {

constexpr VkDeviceSize kBlockBytes = VkDeviceSize{64} << 20;
constexpr VkDeviceSize kBlocksPerHeap = 8; // at least: small heaps have smaller blocks

struct Properties {
    VkMemoryPropertyFlags required;
    VkMemoryPropertyFlags preferred;
};

Properties propertiesOf(Memory kind) {
    constexpr VkMemoryPropertyFlags kMapped =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    switch (kind) {
        case Memory::Upload:
            return {kMapped, 0};
        case Memory::ReadBack:
            return {kMapped, VK_MEMORY_PROPERTY_HOST_CACHED_BIT};
        case Memory::Device:
            break;
    }
    return {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
}

} // namespace

DeviceMemory::DeviceMemory(VkPhysicalDevice physical, VkDevice device, bool addressable)
    : device_(device), addressable_(addressable) {
    VkPhysicalDeviceMaintenance3Properties limits{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &limits};
    vkGetPhysicalDeviceProperties2(physical, &properties);
    deviceName_ = properties.properties.deviceName;
    largest_ = limits.maxMemoryAllocationSize;
    vkGetPhysicalDeviceMemoryProperties(physical, &properties_);
}

Allocation DeviceMemory::allocate(const VkMemoryRequirements& needs, Memory kind, const std::string& what) {
    const std::uint32_t type = typeFor(needs.memoryTypeBits, kind);
    if (needs.size > blockBytes(type) / 2) return allocateAlone(needs, kind, what);
    for (Block& block : blocks_) {
        if (block.type != type || !block.isShared) continue;
        if (const auto offset = block.free.take(needs.size, needs.alignment)) {
            return take(block, *offset, needs.size, kind);
        }
    }
    // Where there is no memory for a block, there may be enough for this.
    if (addBlock(type, blockBytes(type), true) != VK_SUCCESS) return allocateAlone(needs, kind, what);
    return take(blocks_.back(), *blocks_.back().free.take(needs.size, needs.alignment), needs.size, kind);
}

Allocation DeviceMemory::allocateAlone(const VkMemoryRequirements& needs, Memory kind, const std::string& what) {
    check(addBlock(typeFor(needs.memoryTypeBits, kind), needs.size, false), what);
    return take(blocks_.back(), *blocks_.back().free.take(needs.size, 1), needs.size, kind);
}

Allocation DeviceMemory::take(Block& block, VkDeviceSize offset, VkDeviceSize bytes, Memory kind) {
    Allocation allocation;
    allocation.owner_ = this;
    allocation.block_ = &block;
    allocation.offset_ = offset;
    allocation.bytes_ = bytes;
    allocation.kind_ = kind;
    if (kind == Memory::Device) deviceBytes_ += bytes;
    return allocation;
}

// The first type that has all wanted properties, which is the fastest of them (Vulkan's order).
std::uint32_t DeviceMemory::typeFor(std::uint32_t allowed, Memory kind) const {
    const auto [required, preferred] = propertiesOf(kind);
    for (const VkMemoryPropertyFlags wanted : {required | preferred, required}) {
        for (std::uint32_t type = 0; type < properties_.memoryTypeCount; ++type) {
            const bool isAllowed = (allowed >> type & 1u) != 0;
            if (isAllowed && (properties_.memoryTypes[type].propertyFlags & wanted) == wanted) return type;
        }
    }
    throw RenderError(deviceName_ + " has no memory of the kind that is needed");
}

VkDeviceSize DeviceMemory::blockBytes(std::uint32_t type) const {
    return std::min(kBlockBytes,
                    properties_.memoryHeaps[properties_.memoryTypes[type].heapIndex].size / kBlocksPerHeap);
}

VkResult DeviceMemory::addBlock(std::uint32_t type, VkDeviceSize bytes, bool isShared) {
    VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, addressable_ ? &flags : nullptr};
    info.allocationSize = bytes;
    info.memoryTypeIndex = type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    if (const VkResult result = vkAllocateMemory(device_, &info, nullptr, &memory); result != VK_SUCCESS) return result;
    Handle<VkDeviceMemory> owner(device_, memory, vkFreeMemory);
    void* mapped = nullptr;
    if ((properties_.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0) {
        const VkResult result = vkMapMemory(device_, memory, 0, VK_WHOLE_SIZE, 0, &mapped);
        if (result != VK_SUCCESS) return result;
        // Mappings are aligned. Where addresses run out, Mesa's software driver hands out mmap's -1 as a success.
        constexpr std::uintptr_t kMinAlignment = 64; // of minMemoryMapAlignment
        if (mapped == nullptr || reinterpret_cast<std::uintptr_t>(mapped) % kMinAlignment != 0)
            return VK_ERROR_MEMORY_MAP_FAILED;
    }
    blocks_.push_back({std::move(owner), type, isShared, static_cast<std::byte*>(mapped), FreeList(bytes)});
    return VK_SUCCESS;
}

Allocation::~Allocation() {
    if (block_ == nullptr) return;
    if (kind_ == Memory::Device) owner_->deviceBytes_ -= bytes_;
    block_->free.give(offset_, bytes_);
    if (block_->free.isWhole()) owner_->blocks_.remove_if([this](const auto& block) { return &block == block_; });
}

void Allocation::swap(Allocation& other) noexcept {
    std::swap(owner_, other.owner_);
    std::swap(block_, other.block_);
    std::swap(offset_, other.offset_);
    std::swap(bytes_, other.bytes_);
    std::swap(kind_, other.kind_);
}

} // namespace rt::vulkan
