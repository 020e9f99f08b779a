// Memory of a device from a few large blocks: a driver need not allow more than 4096 allocations at a time, and each of
// them takes it long.
#pragma once
#include <cstddef>
#include <cstdint>
#include <list>
#include <string>
#include <utility>

#include <vulkan/vulkan.h>

#include "Common/Vulkan/FreeList.h"
#include "Common/Vulkan/Handle.h"

namespace rt::vulkan {

enum class Memory {
    Device,   // fast for the device, not for the host
    Upload,   // mapped; the host writes, the device reads
    ReadBack, // mapped; the device writes, the host reads
};

class Allocation;

// Blocks hold buffers only, and each image has memory of its own: so no two neighbours in a block fall under
// bufferImageGranularity. Blocks that the host can see are mapped as long as they exist; one is freed when nothing is
// left in it. Not thread-safe, destructors of allocations included; must outlive them.
class DeviceMemory {
  public:
    // `addressable`: what is bound to it may be asked for its address, for which the device has bufferDeviceAddress
    // enabled.
    DeviceMemory(VkPhysicalDevice physical, VkDevice device, bool addressable);

    // A part of a block, or memory of its own where that would fill more than half of one. `what` begins the message
    // where that fails. Throws RenderError or DeviceLostError.
    Allocation allocate(const VkMemoryRequirements& needs, Memory kind, const std::string& what);
    // Memory of its own.
    Allocation allocateAlone(const VkMemoryRequirements& needs, Memory kind, const std::string& what);

    VkDevice device() const { return device_; }
    const std::string& deviceName() const { return deviceName_; }
    bool isAddressable() const { return addressable_; }
    VkDeviceSize largest() const { return largest_; }         // bytes, of an allocation that the driver allows
    VkDeviceSize deviceBytes() const { return deviceBytes_; } // that allocations of Memory::Device hold at present
    std::size_t blockCount() const { return blocks_.size(); } // allocations of the driver

  private:
    friend class Allocation;
    struct Block {
        Handle<VkDeviceMemory> memory;
        std::uint32_t type;
        bool isShared;
        std::byte* mapped; // null where the host cannot see it
        FreeList free;
    };

    std::uint32_t typeFor(std::uint32_t allowed, Memory kind) const;
    VkDeviceSize blockBytes(std::uint32_t type) const;
    VkResult addBlock(std::uint32_t type, VkDeviceSize bytes, bool isShared);
    Allocation take(Block& block, VkDeviceSize offset, VkDeviceSize bytes, Memory kind);

    VkDevice device_;
    bool addressable_;
    std::string deviceName_;
    VkDeviceSize largest_ = 0;
    VkPhysicalDeviceMemoryProperties properties_{};
    std::list<Block> blocks_; // allocations point to them
    VkDeviceSize deviceBytes_ = 0;
};

// A piece of memory, which is given back at its end.
class Allocation {
  public:
    Allocation() = default;
    Allocation(Allocation&& other) noexcept { swap(other); }
    Allocation& operator=(Allocation&& other) noexcept {
        Allocation(std::move(other)).swap(*this);
        return *this;
    }
    ~Allocation();

    VkDeviceMemory memory() const { return block_->memory.get(); }
    VkDeviceSize offset() const { return offset_; } // in memory()
    // The first of its bytes; null without memory and where the host cannot see it.
    std::byte* mapped() const {
        return block_ != nullptr && block_->mapped != nullptr ? block_->mapped + offset_ : nullptr;
    }

  private:
    friend class DeviceMemory;
    void swap(Allocation& other) noexcept;

    DeviceMemory* owner_ = nullptr;
    DeviceMemory::Block* block_ = nullptr;
    VkDeviceSize offset_ = 0;
    VkDeviceSize bytes_ = 0;
    Memory kind_ = Memory::Device;
};

} // namespace rt::vulkan
