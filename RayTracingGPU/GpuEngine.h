// The GPU renderer, in launches of bounded time: paths through the Vulkan ray tracing pipeline, or through compute
// shaders with a tree of our own or with ray queries.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "Common/Render/Engine.h"
#include "Common/Render/Names.h"
#include "Common/Vulkan/VulkanContext.h"

namespace rt::gpu {

struct GpuEngineOptions {
    // Compiled pipelines, and the rates that Auto measures, are kept in the user's cache folder.
    bool pipelineCache = true;
    // Tiles (times replicates) of the film that are on the device at a time: 4096 x 4096 pixels, 400 MB. Larger images
    // are rendered part by part, to the same bits.
    std::uint32_t regionSlots = 1u << 18;
    app::GpuEngineKind engine = app::GpuEngineKind::Auto;
    // Whether Auto measures. Otherwise it is the engine that is likely to be the fastest: ranks must choose alike.
    bool measures = true;
    std::optional<double> launchSeconds; // of a launch, at most; else as suits the device
    // For how long some pixels may have more samples than others, where the number of samples is known, and none comes
    // sooner. Nobody watches a render without a window, which is faster so: rays of a tile are alike.
    double passSeconds = 0;
    // Filters on the device even if that is the processor, which its own filter suits better. For tests.
    bool denoisesInSoftware = false;
};

inline constexpr double kUnwatchedPassSeconds = 1;

// `context` must outlive the engine. Throws NoDeviceError when its device does not have the engine that is asked for.
// Failures of the device are RenderErrors; film() then returns the last copy on the host, which is at most
// kRefreshSeconds old.
std::unique_ptr<app::Engine> makeGpuEngine(vulkan::VulkanContext& context, const GpuEngineOptions& options = {});

inline constexpr double kRefreshSeconds = 5;

} // namespace rt::gpu
