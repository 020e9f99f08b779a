// The kernels of a render, and the constants that they are compiled for and that they read.
#pragma once
#include <memory>
#include <optional>

#include "Common/Render/Settings.h"
#include "Common/Scene/CompiledScene.h"
#include "Common/Vulkan/Buffer.h"
#include "Common/Vulkan/PipelineCache.h"
#include "Common/Vulkan/VulkanContext.h"
#include "RayTracingGPU/GpuScene.h"
#include "RayTracingGPU/Kernels.h"
#include "RayTracingGPU/LaunchQueue.h"
#include "RayTracingGPU/RenderBindings.h"
#include "RayTracingGPU/SpecializationConstants.h"

namespace rt::gpu {

class RenderKernels {
  public:
    // Of an engine that was chosen. `cache` must outlive it.
    RenderKernels(vulkan::VulkanContext& context, vulkan::PipelineCache& cache, app::GpuEngineKind engine);

    // For a render of the scene: uploads its constants, and compiles its kernels unless they are those of the last
    // render. Seconds that this took; nothing if it did not.
    std::optional<double> prepare(const GpuScene& scene, const scene::CameraDesc& camera,
                                  const app::RenderSettings& settings, shared::Features features,
                                  shared::RenderParams params);

    // All of these: of a render that has been prepared.
    LaunchKernels ofLaunches() const { return {*paths_, reuse_.get()}; }
    bool sharePaths() const { return reuse_ != nullptr; }
    const Kernel* paths() const { return paths_.get(); } // null before
    const Kernel& firstHits();
    std::unique_ptr<Kernel> make(KernelPurpose purpose);

  private:
    void upload(const GpuScene& scene, const scene::CameraDesc& camera, const app::RenderSettings& settings,
                shared::RenderParams& params);

    vulkan::VulkanContext& context_;
    vulkan::PipelineCache& cache_;
    app::GpuEngineKind engine_;
    RenderBindings bindings_;
    vulkan::Buffer uniforms_;           // RenderConstants
    vulkan::Buffer edges_, edgeParts_;  // of lights, of which these tell
    SpecializationConstants constants_; // that the kernels were compiled for
    std::unique_ptr<Kernel> paths_;
    std::unique_ptr<Kernel> reuse_;     // if samples share their paths
    std::unique_ptr<Kernel> firstHits_; // once it was asked for
};

} // namespace rt::gpu
