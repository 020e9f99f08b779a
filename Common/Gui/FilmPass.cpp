#include "Common/Gui/FilmPass.h"

#include <cstring>

#include "Common/Vulkan/Barrier.h"
#include "Common/Vulkan/Check.h"
#include "Present.frag.h"
#include "Present.vert.h"

namespace rt::gui {
namespace {

using vulkan::check;
using vulkan::Handle;

constexpr const char* kWhat = "Preparing the picture";

Handle<VkPipeline> createPipeline(VkDevice device, VkRenderPass renderPass, VkPipelineLayout layout) {
    const auto vertex = vulkan::makeShaderModule(device, Present_vert);
    const auto fragment = vulkan::makeShaderModule(device, Present_frag);
    const std::array stages{vulkan::shaderStage(VK_SHADER_STAGE_VERTEX_BIT, vertex.get()),
                            vulkan::shaderStage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment.get())};
    return vulkan::makeGraphicsPipeline(device, VK_NULL_HANDLE, layout, renderPass, stages, {}, kWhat);
}

// Every n-th pixel of every n-th row.
void copyReduced(const image::Image& image, std::uint32_t n, float* to) {
    for (std::uint32_t y = 0; y + n <= image.height; y += n) {
        for (std::uint32_t x = 0; x + n <= image.width; x += n, to += 3) std::memcpy(to, image.pixel(x, y), 12);
    }
}

} // namespace

FilmPass::FilmPass(GraphicsDevice& device, VkRenderPass renderPass) : device_(device) {
    std::array<VkDescriptorSetLayoutBinding, 2> bindings{};
    for (std::uint32_t i = 0; i < bindings.size(); ++i) {
        bindings[i] = {i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr};
    }
    bindings_ = vulkan::DescriptorSet(device.device(), bindings, kWhat);
    const VkPushConstantRange push{VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(PresentConstants)};
    layout_ = vulkan::makePipelineLayout(device.device(), push, bindings_.layout(), kWhat);
    pipeline_ = createPipeline(device.device(), renderPass, layout_.get());
    for (std::size_t slot = 0; slot < images_.size(); ++slot) provide(slot, 12);
}

// A buffer of another size. What used the one before must be over.
void FilmPass::provide(std::size_t slot, VkDeviceSize bytes) {
    if (images_[slot].bytes() == bytes) return;
    check(vkDeviceWaitIdle(device_.device()), "Drawing on " + device_.name());
    images_[slot] = {};
    images_[slot] = vulkan::Buffer(device_.memory(), bytes, 0, vulkan::Memory::Device, "the picture");
    bindings_.write(static_cast<std::uint32_t>(slot), VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, images_[slot].get());
}

void FilmPass::upload(VkCommandBuffer commands, std::uint32_t frame, Slot which, const image::Image& image) {
    const auto slot = static_cast<std::size_t>(which);
    std::uint32_t n = 1;
    while (VkDeviceSize{image.width / n} * (image.height / n) * 12 > device_.maxStorageBytes()) ++n;
    const std::uint32_t width = image.width / n, height = image.height / n;
    const VkDeviceSize bytes = VkDeviceSize{width} * height * 12;
    if (bytes == 0) return;
    provide(slot, bytes);
    vulkan::Buffer& staging = staging_[frame][slot];
    if (staging.bytes() != bytes) {
        staging = {};
        staging = vulkan::Buffer(device_.memory(), bytes, 0, vulkan::Memory::Upload, "the picture");
    }
    copyReduced(image, n, staging.mapped<float>().data());
    sizes_[slot] = {width, height};
    if (which == Slot::Picture) reduction_ = n;

    vulkan::barrier(commands, vulkan::kFragmentRead | vulkan::kTransferWrite, vulkan::kTransferWrite);
    const VkBufferCopy region{0, 0, bytes};
    vkCmdCopyBuffer(commands, staging.get(), images_[slot].get(), 1, &region);
    vulkan::barrier(commands, vulkan::kTransferWrite, vulkan::kFragmentRead);
}

void FilmPass::draw(VkCommandBuffer commands, VkExtent2D extent, PresentConstants constants,
                    const VkRect2D& part) const {
    constants.width = sizes_[0][0];
    constants.height = sizes_[0][1];
    constants.scale *= static_cast<float>(reduction_);
    if (sizes_[1] != sizes_[0]) { // a held image of another size cannot be compared
        constants.split = -1;
        constants.flags &= ~kDifference;
    }
    const VkViewport viewport{0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.get());
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &part);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(), 0, 1, &bindings_.get(), 0,
                            nullptr);
    vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof constants, &constants);
    vkCmdDraw(commands, 3, 1, 0, 0);
}

} // namespace rt::gui
