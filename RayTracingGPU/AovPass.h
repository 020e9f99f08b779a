// First-hit features of an image, band by band.
#pragma once
#include "Common/App/Engine.h"
#include "RayTracingGPU/RtPipeline.h"

namespace rt::gpu {

// Averages over the first `samples` samples of each pixel. The bindings are those of the render.
app::AovImages renderAovPass(vulkan::VulkanContext& context, const RenderBindings& bindings, const RtPipeline& pipeline,
                             std::uint32_t width, std::uint32_t height, const app::AovRequest& request,
                             std::uint32_t samples);

}  // namespace rt::gpu
