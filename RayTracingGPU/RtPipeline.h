// A ray tracing pipeline.
#pragma once
#include <memory>
#include <string>

#include "Common/Vulkan/PipelineCache.h"
#include "RayTracingGPU/Kernel.h"
#include "RayTracingGPU/RenderBindings.h"
#include "RayTracingGPU/ShaderTable.h"
#include "RayTracingGPU/SpecializationConstants.h"

namespace rt::gpu {

class RtPipeline final : public Kernel {
  public:
    // With only the shader groups that the constants need. `bindings` must outlive it.
    RtPipeline(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache, const RenderBindings& bindings,
               const SpecializationConstants& constants, Shader rayGeneration);

    vulkan::Access access() const override {
        return {VK_PIPELINE_STAGE_RAY_TRACING_SHADER_BIT_KHR, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT};
    }
    // The groups that exist: "paths+quads+spheres".
    const std::string& name() const override { return name_; }
    VkPipeline pipeline() const override { return pipeline_.get(); }

  private:
    void record(VkCommandBuffer commands, const void* launch, std::uint32_t bytes,
                std::uint32_t invocations) const override;

    const RenderBindings& bindings_;
    std::string name_;
    vulkan::Handle<VkPipeline> pipeline_;
    std::unique_ptr<ShaderTable> table_;
};

} // namespace rt::gpu
