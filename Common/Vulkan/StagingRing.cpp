#include "Common/Vulkan/StagingRing.h"

#include <algorithm>
#include <cstring>

#include "Common/Core/Error.h"
#include "Common/Vulkan/Barrier.h"

namespace rt::vulkan {
namespace {

constexpr VkDeviceSize kPieceBytes = VkDeviceSize{8} << 20;

} // namespace

StagingRing::Slot::Slot(VulkanContext& context)
    : run(context), bytes(context.memory(), kPieceBytes, 0, Memory::Upload, "uploads") {}

StagingRing::StagingRing(VulkanContext& context)
    : context_(context), slots_{Slot(context), Slot(context), Slot(context)} {}

void StagingRing::await(Slot& slot) {
    if (!slot.isBusy) return;
    slot.isBusy = false;
    slot.run.finish();
}

void StagingRing::upload(const Buffer& to, std::span<const std::byte> data, VkDeviceSize offset) {
    try {
        for (VkDeviceSize done = 0; done < data.size(); done += kPieceBytes) {
            Slot& slot = slots_[next_];
            next_ = (next_ + 1) % slots_.size();
            await(slot);
            const VkDeviceSize bytes = std::min(kPieceBytes, data.size() - done);
            std::memcpy(slot.bytes.mapped<std::byte>().data(), data.data() + done, bytes);
            slot.run.begin([&](VkCommandBuffer commands) {
                const VkBufferCopy region{0, offset + done, bytes};
                vkCmdCopyBuffer(commands, slot.bytes.get(), to.get(), 1, &region);
                barrier(commands, kTransferWrite, context_.bufferUses());
            });
            slot.isBusy = true;
        }
        for (Slot& slot : slots_) await(slot);
    } catch (...) {
        // The destination may be gone soon: nothing may write to it any more.
        for (Slot& slot : slots_) {
            try {
                await(slot);
            } catch (const RenderError&) { // the device is abandoned
            }
        }
        throw;
    }
}

void upload(VulkanContext& context, const Buffer& to, std::span<const std::byte> data, VkDeviceSize offset) {
    context.staging().upload(to, data, offset);
}

void download(VulkanContext& context, const Buffer& from, std::span<std::byte> data, VkDeviceSize offset) {
    if (data.empty()) return;
    const VkDeviceSize piece = std::min<VkDeviceSize>(data.size(), kPieceBytes);
    const Buffer staging(context.memory(), piece, 0, Memory::ReadBack, "downloads");
    for (VkDeviceSize done = 0; done < data.size(); done += piece) {
        const VkDeviceSize bytes = std::min<VkDeviceSize>(piece, data.size() - done);
        context.run([&](VkCommandBuffer commands) {
            const VkBufferCopy region{offset + done, 0, bytes};
            vkCmdCopyBuffer(commands, from.get(), staging.get(), 1, &region);
            barrier(commands, kTransferWrite, kHostRead);
        });
        std::memcpy(data.data() + done, staging.mapped<std::byte>().data(), bytes);
    }
}

} // namespace rt::vulkan
