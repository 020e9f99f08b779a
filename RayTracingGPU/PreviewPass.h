// A picture by rasterisation of the scene that the engine has on its device: instanced, textured, lit without shadows.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "Common/Render/Engine.h"
#include "Common/Vulkan/PipelineCache.h"
#include "Common/Vulkan/Pipelines.h"
#include "Common/Vulkan/StagingRing.h"
#include "RayTracingGPU/GpuScene.h"
#include "RayTracingGPU/Launches.h"
#include "RayTracingGPU/PreviewTarget.h"

namespace rt::gpu {

// Of one scene, whose buffers its shaders read. A device that cannot draw (DeviceInfo::draws) cannot have one. However
// large the scene and the image, the device is asked for a short while's work at a time.
class PreviewPass {
  public:
    // `scene` must outlive it.
    PreviewPass(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache, const GpuScene& scene);

    // One ray through the middle of each pixel and of the lens, at the opening of the shutter. Throws RenderError, also
    // where the image is larger than the device draws.
    app::Preview render(const scene::CameraDesc& camera, std::uint32_t width, std::uint32_t height);

  private:
    // Primitives of one kind in one geometry, with their instances.
    struct Draw {
        std::uint32_t shape = 0;
        std::uint32_t firstVertex = 0, vertexCount = 0;
        std::uint32_t firstInstance = 0, instanceCount = 0;
    };

    void listDraws();
    void createPipelines(const vulkan::PipelineCache& cache);
    vulkan::Handle<VkPipeline> createDrawing(const vulkan::PipelineCache& cache, std::uint32_t shape);
    void uploadConstants(const scene::CameraDesc& camera, std::uint32_t width, std::uint32_t height);
    void bind(VkCommandBuffer commands, VkPipelineBindPoint point, VkPipeline pipeline) const;
    void drawBand(const Band& band);
    std::uint64_t recordDraw(VkCommandBuffer commands, const Draw& draw, std::uint64_t done,
                             std::uint64_t maximum) const;
    void finishBand(const Band& band);

    vulkan::VulkanContext& context_;
    const GpuScene& scene_;
    shared::Features features_;
    std::vector<Draw> draws_;
    vulkan::Buffer indices_; // see PreviewLaunch
    vulkan::Buffer constants_;
    shared::PreviewLaunch launch_{};

    vulkan::DescriptorSet bindings_;
    vulkan::Handle<VkPipelineLayout> layout_;
    vulkan::Handle<VkRenderPass> clearing_, goingOn_;   // compatible render passes
    std::array<vulkan::Handle<VkPipeline>, 4> drawing_; // by shape: kSphere, kQuad, kTriangle, kRound
    vulkan::Handle<VkPipeline> finishing_;
    PreviewTarget target_;
    LaunchSize vertices_; // of a submission, whose samples they are
};

} // namespace rt::gpu
