// The compute shader that traces rays on its own, for one set of decisions and one shape of scene.
#pragma once
#include <cstdint>
#include <string>

#include "Common/Accel/GpuBvh.h"
#include "Common/Vulkan/PipelineCache.h"
#include "RayTracingGPU/Kernel.h"
#include "RayTracingGPU/RenderBindings.h"

namespace rt::gpu {

inline constexpr std::uint32_t kGroupSize = 64; // invocations of a work group

// Specialisation constants behind the decisions, in the order of their ids in PathTrace.comp and Traverse.glsl.
struct TraversalShape {
    std::uint32_t groupSize = kGroupSize;
    std::uint32_t treeDepth = 0;
    std::uint32_t isLinear = 0;
    std::uint32_t listedSpheres = 0;
    std::uint32_t listedQuads = 0;
    std::uint32_t listedTriangles = 0;
    bool operator==(const TraversalShape&) const = default;
};

TraversalShape traversalShape(const accel::GpuBvh& bvh);

class ComputePipeline final : public Kernel {
  public:
    // `bindings` must outlive it.
    ComputePipeline(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache, const RenderBindings& bindings,
                    const PipelineDecisions& decisions, const TraversalShape& shape, Shader shader);

    // How rays are traced and through what: "list+quads+spheres", "tree+triangles+instances".
    const std::string& name() const override { return name_; }

  private:
    void record(VkCommandBuffer commands, const void* launch, std::uint32_t bytes,
                std::uint32_t invocations) const override;

    const RenderBindings& bindings_;
    std::string name_;
    vulkan::Handle<VkPipeline> pipeline_;
};

} // namespace rt::gpu
