// The ray tracing pipeline for one set of decisions, and what it is bound to.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "Common/Shared/Types.h"
#include "Common/Vulkan/PipelineCache.h"
#include "Common/Vulkan/VulkanResources.h"
#include "RayTracingGPU/EmbeddedShaders.h"
#include "RayTracingGPU/ShaderTable.h"

namespace rt::gpu {

// Specialisation constants, in the order of their ids in Bindings.glsl.
struct PipelineDecisions {
    std::uint32_t features = 0;
    std::uint32_t lightSampling = 0;
    std::uint32_t lightSelection = 0;
    std::uint32_t sphereLight = 0;
    std::uint32_t quadLight = 0;
    std::uint32_t triangleLight = 0;
    std::uint32_t samplerKind = 0;
    std::uint32_t russianRoulette = 0;
    bool operator==(const PipelineDecisions&) const = default;
};

PipelineDecisions makeDecisions(std::uint32_t features, const shared::RenderParams& params);

// Layout and contents of the one descriptor set: the top level structure and the uniform buffer.
class RenderBindings {
  public:
    // Stages read up to `pushBytes` of push constants.
    RenderBindings(vulkan::VulkanContext& context, std::uint32_t pushBytes);
    void update(VkAccelerationStructureKHR topLevel, const vulkan::Buffer& constants);
    void bind(VkCommandBuffer commands) const;
    VkPipelineLayout layout() const { return pipelineLayout_.get(); }

  private:
    VkDevice device_;
    vulkan::Handle<VkDescriptorSetLayout> setLayout_;
    vulkan::Handle<VkPipelineLayout> pipelineLayout_;
    vulkan::Handle<VkDescriptorPool> pool_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};

class RtPipeline {
  public:
    // With only the shader groups that the features need.
    RtPipeline(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache, const RenderBindings& bindings,
               const PipelineDecisions& decisions, Shader rayGeneration);

    // The pipeline with these push constants, for width * height invocations.
    template <class Launch>
    void trace(VkCommandBuffer commands, const RenderBindings& bindings, const Launch& launch, std::uint32_t width,
               std::uint32_t height) const {
        static_assert(sizeof(Launch) <= 128, "Vulkan guarantees 128 bytes");
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, pipeline_.get());
        bindings.bind(commands);
        vkCmdPushConstants(commands, bindings.layout(), VK_SHADER_STAGE_RAYGEN_BIT_KHR, 0, sizeof launch, &launch);
        table_->trace(commands, width, height);
    }

    const PipelineDecisions& decisions() const { return decisions_; }
    // Names of the groups that exist: "paths+shadow+quads+spheres".
    const std::string& name() const { return name_; }

  private:
    PipelineDecisions decisions_;
    std::string name_;
    vulkan::Handle<VkPipeline> pipeline_;
    std::unique_ptr<ShaderTable> table_;
};

vulkan::Handle<VkShaderModule> makeShaderModule(VkDevice device, Shader shader);

}  // namespace rt::gpu
