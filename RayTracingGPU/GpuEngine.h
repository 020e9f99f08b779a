// The GPU renderer: paths through the Vulkan ray tracing pipeline, in launches of bounded time.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "Common/App/Engine.h"
#include "Common/Vulkan/VulkanContext.h"

namespace rt::gpu {

struct GpuEngineOptions {
    // Compiled pipelines are kept in the user's cache folder.
    bool pipelineCache = true;
    // Tiles (times replicates) of the film that are on the device at a time: 4096 x 4096 pixels, 400 MB. Larger images are
    // rendered part by part, to the same bits.
    std::uint32_t regionSlots = 1u << 18;
};

// `context` must outlive the engine. Failures of the device are RenderErrors; film() then returns the last copy on the host,
// which is at most kRefreshSeconds old.
std::unique_ptr<app::Engine> makeGpuEngine(vulkan::VulkanContext& context, const GpuEngineOptions& options = {});

inline constexpr double kRefreshSeconds = 5;

} // namespace rt::gpu
