// What each pixel of an image costs, band by band.
#pragma once
#include "Common/Image/Image.h"
#include "RayTracingGPU/RtPipeline.h"

namespace rt::gpu {

// Rays, averaged over the first `samples` samples of each pixel. The bindings are those of the render.
image::Image renderCostPass(vulkan::VulkanContext& context, const RenderBindings& bindings, const RtPipeline& pipeline,
                            std::uint32_t width, std::uint32_t height, std::uint32_t samples);

}  // namespace rt::gpu
