// Renders a film on a device: pass by pass, launch by launch, and part by part where it does not fit as a whole. It
// keeps a copy on the host, and knows which of the two is ahead.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "Common/Image/Film.h"
#include "Common/Image/FilmTiles.h"
#include "Common/Render/Engine.h"
#include "Common/Render/Stopwatch.h"
#include "Common/Vulkan/Buffer.h"
#include "Common/Vulkan/PipelineCache.h"
#include "Common/Vulkan/VulkanContext.h"
#include "RayTracingGPU/DeviceFilm.h"
#include "RayTracingGPU/FilmCopy.h"
#include "RayTracingGPU/GpuEngine.h"
#include "RayTracingGPU/LaunchQueue.h"
#include "RayTracingGPU/Launches.h"
#include "RayTracingGPU/Pass.h"
#include "RayTracingGPU/RenderKernels.h"

namespace rt::gpu {

class FilmRenderer {
  public:
    // `kernels` and `report`, whose figures of rendering are added to, must outlive it.
    FilmRenderer(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache, const GpuEngineOptions& options,
                 app::GpuEngineKind engine, const RenderKernels& kernels, app::EngineReport& report);

    // What is to be rendered from now on, into the film that follows.
    void adopt(const app::RenderSettings& settings, shared::Features features, bool sharesPaths);
    void setFilm(image::Film film);
    // Memory for tiles comes with the leases of a film that is a part.
    void setPart(image::Film film);
    // The kernels have been prepared; `anew`: how long they take is not known yet.
    void makeReady(bool anew);
    void renderOnly(image::TileList tiles, std::uint32_t spp, std::span<const std::byte> packed);
    app::RenderStatus renderSome(const app::Budget& budget);

    const image::Film& film();
    // From the device; nothing where the host has what there is.
    std::optional<app::TilesToPack> takeTiles(const image::TileList& tiles);
    std::optional<app::Snapshot> snapshot();
    // As DeviceFilm's; 0 also where the film is not on the device. Where they throw, the film is there still.
    std::uint64_t resolveHalves(const vulkan::Buffer& to);
    std::uint64_t resolveOne(const vulkan::Buffer& to);

    // The device was lost: nothing is read from it any more.
    bool hasFailed() const { return failed_; }
    void giveUpDevice() { failed_ = true; } // other work was told so

  private:
    void loadTiles();
    bool beginPass(const std::atomic<bool>* cancel);
    void planSamples(const std::atomic<bool>* cancel);
    void launchNext();
    void beginLaunch(shared::FilmLaunch launch);
    void finishPaths();
    void endLaunch();
    void endLaunches();
    bool nextRegion();
    void refresh();
    // Whatever reads from the device: where that fails, the next call returns what the host has.
    template <class Function>
    auto reading(Function read);

    vulkan::VulkanContext& context_;
    const vulkan::PipelineCache& cache_;
    const GpuEngineOptions& options_;
    const RenderKernels& kernels_;
    app::EngineReport& report_;
    std::optional<FilmResolver> resolver_; // once it was needed
    LaunchQueue launches_;
    ReadBackPool readBacks_;

    app::RenderSettings settings_;
    shared::Features features_;
    bool sharesPaths_ = false;

    image::Film film_;                   // on the host: the whole film, or the part of a lease
    image::TileList tiles_;              // of it, that are to be rendered
    std::optional<std::uint32_t> limit_; // samples per pixel that renderOnly() has asked for
    std::unique_ptr<DeviceFilm> region_; // those on the device: all of them unless they are many; null before a lease
    bool dirty_ = false;                 // region_ is ahead of film_
    bool failed_ = false;                // the device did: nothing may be read from it any more
    app::Stopwatch sinceRefresh_;
    std::uint64_t samplesDone_ = 0;        // of the tiles, what region_ is ahead included
    std::uint64_t samplesTotal_ = 0;       // of the tiles, when they are done
    std::uint64_t begun_ = 0;              // samples per pixel that the passes so far lead to
    std::uint64_t goal_ = 0;               // that they lead to in the end, or before there is a plan
    std::optional<Pass> pass_;             // that is in progress
    std::optional<LaunchSize> launchSize_; // of this scene and these kernels
};

} // namespace rt::gpu
