// A compute shader that traces rays: on its own, or by ray queries.
#pragma once
#include <cstdint>
#include <string>

#include "Common/Vulkan/PipelineCache.h"
#include "RayTracingGPU/Kernel.h"
#include "RayTracingGPU/RenderBindings.h"
#include "RayTracingGPU/SpecializationConstants.h"

namespace rt::gpu {

class ComputePipeline final : public Kernel {
  public:
    // `bindings` must outlive it.
    ComputePipeline(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache, const RenderBindings& bindings,
                    const SpecializationConstants& constants, Shader shader, bool queries);

    vulkan::Access access() const override { return vulkan::kComputeRead | vulkan::kComputeWrite; }
    // How rays are traced and through what: "list+quads+spheres", "tree+triangles+instances",
    // "queries+spheres".
    const std::string& name() const override { return name_; }
    VkPipeline pipeline() const override { return pipeline_.get(); }

  private:
    void record(VkCommandBuffer commands, const void* launch, std::uint32_t bytes,
                std::uint32_t invocations) const override;

    const RenderBindings& bindings_;
    std::string name_;
    std::uint32_t groupSize_;
    vulkan::Handle<VkPipeline> pipeline_;
};

} // namespace rt::gpu
