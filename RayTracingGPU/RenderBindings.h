// The one descriptor set of a render: what rays are traced through, and the uniform buffer.
#pragma once
#include <cstdint>

#include "Common/Render/Names.h"
#include "Common/Vulkan/Buffer.h"
#include "Common/Vulkan/Pipelines.h"
#include "Common/Vulkan/VulkanContext.h"

namespace rt::gpu {

class RenderBindings {
  public:
    // Of an engine, whose shaders read up to `pushBytes` of push constants.
    RenderBindings(vulkan::VulkanContext& context, app::GpuEngineKind engine, std::uint32_t pushBytes);

    // The uniform buffer, and the top level of the acceleration structure, of engines that trace rays through one.
    void update(const vulkan::Buffer& constants, VkAccelerationStructureKHR topLevel) const;
    // The uniform buffers of Bindings.glsl and Traverse.glsl: of the engine with a tree of our own.
    void update(const vulkan::Buffer& constants, const vulkan::Buffer& linearLists) const;

    // Binds the set and sets push constants.
    void bind(VkCommandBuffer commands, const void* push, std::uint32_t pushBytes) const;
    VkPipelineLayout layout() const { return layout_.get(); }

  private:
    VkPipelineBindPoint bindPoint_;
    VkShaderStageFlags pushStages_;
    vulkan::DescriptorSet set_;
    vulkan::Handle<VkPipelineLayout> layout_;
};

} // namespace rt::gpu
