// What every pipeline is made of, in one call each: shaders, layouts, bindings. All throw RenderError; `what` names
// what could not be done.
#pragma once
#include <cstdint>
#include <span>

#include <vulkan/vulkan.h>

#include "Common/Vulkan/Handle.h"

namespace rt::vulkan {

Handle<VkShaderModule> makeShaderModule(VkDevice device, std::span<const std::uint32_t> code);
// Of what `constants` leave of it, to which alone it may be specialized then (ShaderPruning.h).
Handle<VkShaderModule> makeShaderModule(VkDevice device, std::span<const std::uint32_t> code,
                                        const VkSpecializationInfo& constants);

// The stage's function is main(). `constants` may be null, and must live as long as the result.
VkPipelineShaderStageCreateInfo shaderStage(VkShaderStageFlagBits stage, VkShaderModule module,
                                            const VkSpecializationInfo* constants = nullptr);

// With one range of push constants and one descriptor set, or none where `set` is null.
Handle<VkPipelineLayout> makePipelineLayout(VkDevice device, const VkPushConstantRange& push, VkDescriptorSetLayout set,
                                            const char* what);

// `cache` may be null, here and below.
Handle<VkPipeline> makeComputePipeline(VkDevice device, VkPipelineCache cache, VkPipelineLayout layout,
                                       VkShaderModule module, const VkSpecializationInfo* constants, const char* what,
                                       VkPipelineCreateFlags flags = 0);

// Triangles without vertex buffers, no blending; viewport and scissor are set while recording.
struct Rasterization {
    VkCullModeFlags cull = VK_CULL_MODE_NONE;                     // counter-clockwise is front
    const VkPipelineDepthStencilStateCreateInfo* depth = nullptr; // null: the render pass has no depth
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    bool shadesSamples = false; // each on its own; else once a pixel
};
Handle<VkPipeline> makeGraphicsPipeline(VkDevice device, VkPipelineCache cache, VkPipelineLayout layout,
                                        VkRenderPass renderPass,
                                        std::span<const VkPipelineShaderStageCreateInfo> stages,
                                        const Rasterization& rasterization, const char* what);

// A descriptor set with its layout and its pool.
class DescriptorSet {
  public:
    DescriptorSet() = default;
    DescriptorSet(VkDevice device, std::span<const VkDescriptorSetLayoutBinding> bindings, const char* what);

    VkDescriptorSetLayout layout() const { return layout_.get(); }
    const VkDescriptorSet& get() const { return set_; }
    void write(std::uint32_t binding, VkDescriptorType type, VkBuffer buffer) const;
    void write(std::uint32_t binding, VkAccelerationStructureKHR structure) const;
    void write(std::uint32_t binding, VkImageView sampled) const; // whose texels are fetched by shaders

  private:
    void update(std::uint32_t binding, VkWriteDescriptorSet what) const; // fills in where

    VkDevice device_ = VK_NULL_HANDLE;
    Handle<VkDescriptorSetLayout> layout_;
    Handle<VkDescriptorPool> pool_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};

} // namespace rt::vulkan
