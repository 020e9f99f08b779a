// The one descriptor set of a render: what rays are traced through, and the uniform buffer.
#pragma once
#include <cstdint>

#include "Common/App/Names.h"
#include "Common/Vulkan/VulkanResources.h"

namespace rt::gpu {

class RenderBindings {
  public:
    // Of the pipeline or the compute engine, whose shaders read up to `pushBytes` of push constants.
    RenderBindings(vulkan::VulkanContext& context, app::GpuEngineKind engine, std::uint32_t pushBytes);

    // The uniform buffer, and the top level of the acceleration structure: of the pipeline engine.
    void update(const vulkan::Buffer& constants, VkAccelerationStructureKHR topLevel);
    // The uniform buffers of Bindings.glsl and Traverse.glsl: of the compute engine.
    void update(const vulkan::Buffer& constants, const vulkan::Buffer& flatLists);

    // Binds the set and sets push constants.
    void bind(VkCommandBuffer commands, const void* push, std::uint32_t pushBytes) const;
    VkPipelineLayout layout() const { return pipelineLayout_.get(); }

  private:
    void write(std::uint32_t binding, VkDescriptorType type, const void* next, const VkDescriptorBufferInfo* buffer);
    void writeUniforms(std::uint32_t binding, const vulkan::Buffer& buffer);

    VkDevice device_;
    VkPipelineBindPoint bindPoint_;
    VkShaderStageFlags pushStages_;
    vulkan::Handle<VkDescriptorSetLayout> setLayout_;
    vulkan::Handle<VkPipelineLayout> pipelineLayout_;
    vulkan::Handle<VkDescriptorPool> pool_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};

} // namespace rt::gpu
