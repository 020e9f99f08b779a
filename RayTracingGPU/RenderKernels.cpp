#include "RayTracingGPU/RenderKernels.h"

#include <algorithm>
#include <cstdint>
#include <span>

#include "Common/Render/RenderParams.h"
#include "Common/Render/Stopwatch.h"
#include "Common/Scene/CameraRecord.h"
#include "Common/Scene/Silhouettes.h"
#include "Common/Shared/Base/Features.h"
#include "Common/Vulkan/StagingRing.h"
#include "RayTracingGPU/EngineChoice.h"
#include "Shaders/Records.h"

namespace rt::gpu {

RenderKernels::RenderKernels(vulkan::VulkanContext& context, vulkan::PipelineCache& cache, app::GpuEngineKind engine)
    : context_(context),
      cache_(cache),
      engine_(engine),
      bindings_(context, engine, std::max(sizeof(shared::PathLaunch), sizeof(shared::PixelLaunch))),
      uniforms_(context.memory(), sizeof(shared::RenderConstants), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                vulkan::Memory::Device, "constants") {}

std::optional<double> RenderKernels::prepare(const GpuScene& scene, const scene::CameraDesc& camera,
                                             const app::RenderSettings& settings, shared::Features features,
                                             shared::RenderParams params) {
    upload(scene, camera, settings, params);
    if (usesAccelStructure(engine_)) {
        bindings_.update(uniforms_, scene.topLevel());
    } else {
        bindings_.update(uniforms_, scene.linearLists());
    }
    TraversalShape traversal = scene.shape();
    traversal.groupSize = groupSize(context_, features);
    const SpecializationConstants constants =
        makeSpecializationConstants(features, params, scene.compiled().globals.lightCount, traversal);
    const bool shares = shared::reusesPaths(features, params);
    if (paths_ && constants_ == constants && shares == sharePaths()) return std::nullopt;
    const app::Stopwatch watch;
    paths_ = nullptr;
    reuse_ = nullptr;
    firstHits_ = nullptr;
    constants_ = constants;
    paths_ = makeKernel(context_, cache_, bindings_, engine_, KernelPurpose::Paths, constants_);
    if (shares) reuse_ = makeKernel(context_, cache_, bindings_, engine_, KernelPurpose::Reuse, constants_);
    cache_.save();
    return watch.seconds();
}

void RenderKernels::upload(const GpuScene& scene, const scene::CameraDesc& camera, const app::RenderSettings& settings,
                           shared::RenderParams& params) {
    const scene::CompiledScene& s = scene.compiled();
    shared::RenderConstants constants{};
    constants.arrays = scene.arrays();
    constants.tree = scene.tree();
    constants.globals = s.globals;
    constants.camera = scene::makeCamera(camera, settings.width, settings.height, s.origin);
    const scene::Silhouettes edges = app::splitAtEdges(s, constants.camera, settings, params);
    edges_ = vulkan::deviceArray<std::uint32_t>(context_, edges.bits(), "edges of lights");
    constants.edges = edges_.address();
    edgeParts_ = vulkan::deviceArray<std::uint32_t>(context_, edges.parts, "parts of pixels with edges");
    constants.edgeParts = edgeParts_.address();
    constants.params = params;
    const std::size_t bounds = std::min<std::size_t>(s.lightBounds.size(), shared::kContributionLights);
    std::copy_n(s.lightBounds.begin(), bounds, constants.lightBounds);
    vulkan::upload(context_, uniforms_, std::as_bytes(std::span(&constants, 1)));
}

std::unique_ptr<Kernel> RenderKernels::make(KernelPurpose purpose) {
    std::unique_ptr<Kernel> kernel = makeKernel(context_, cache_, bindings_, engine_, purpose, constants_);
    cache_.save();
    return kernel;
}

const Kernel& RenderKernels::firstHits() {
    if (!firstHits_) firstHits_ = make(KernelPurpose::FirstHits);
    return *firstHits_;
}

} // namespace rt::gpu
