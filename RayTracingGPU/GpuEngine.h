// The GPU renderer: paths through the Vulkan ray tracing pipeline, in launches of bounded time.
#pragma once
#include <memory>
#include <string>

#include "Common/App/Engine.h"
#include "Common/Vulkan/VulkanContext.h"

namespace rt::gpu {

struct GpuEngineOptions {
    // Compiled pipelines are kept in the user's cache folder.
    bool pipelineCache = true;
};

// `context` must outlive the engine. Failures of the device are RenderErrors; film() then returns the last copy on the host,
// which is at most kRefreshSeconds old.
std::unique_ptr<app::Engine> makeGpuEngine(vulkan::VulkanContext& context, const GpuEngineOptions& options = {});

inline constexpr double kRefreshSeconds = 5;

}  // namespace rt::gpu
