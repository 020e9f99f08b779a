// What an engine denoises with on its device, once it has been asked to.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>

#include "Common/Image/Denoise/Denoiser.h"
#include "Common/Render/Engine.h"
#include "Common/Render/PictureDenoiser.h"
#include "Common/Render/Settings.h"
#include "Common/Shared/Base/Types.h"
#include "Common/Vulkan/Buffer.h"
#include "Common/Vulkan/PipelineCache.h"
#include "Common/Vulkan/VulkanContext.h"
#include "RayTracingGPU/DeviceDenoiser.h"
#include "RayTracingGPU/LiveHistory.h"

namespace rt::gpu {

// An engine with a film that may be on its device.
class FilmOnDevice {
  public:
    virtual ~FilmOnDevice() = default;
    virtual class GpuDenoiser& denoiser() = 0;
    virtual std::uint32_t dependentSide() const = 0;
    // As DeviceFilm's.
    virtual std::uint64_t resolveHalves(const vulkan::Buffer& to) = 0;
    virtual std::uint64_t resolveOne(const vulkan::Buffer& to) = 0;
    // First-hit features, kSurfaceValues of each pixel. False: cancelled.
    virtual bool renderSurfaces(std::uint32_t samples, const vulkan::Buffer& to, const std::atomic<bool>& cancel) = 0;
};

class GpuDenoiser {
  public:
    GpuDenoiser(vulkan::VulkanContext& context, vulkan::PipelineCache& cache)
        : context_(context), pipelines_(context, cache), history_(context) {}

    // The picture of these halves, as image::denoise() makes it. `surfaces`: whose features are taken, on the device,
    // in place of those that come with the halves. Throws RenderError, and Interrupted.
    app::DenoisedPicture denoise(const image::DenoiseInput& input, std::uint32_t dependentSide, bool details,
                                 FilmOnDevice* surfaces = nullptr);
    // For pictures of this size; the last one, if it is that.
    DeviceDenoiser& of(std::uint32_t width, std::uint32_t height);
    // Features of at least so many samples, which stay until they are forgotten. False: cancelled.
    bool provideSurfaces(FilmOnDevice& film, std::uint32_t samples, const std::atomic<bool>& cancel);
    // Another film begins.
    void begin(const shared::Camera& camera, const app::RenderSettings& settings);
    LiveHistory& history() { return history_; }
    // What the last run of it says besides pictures.
    void report(app::DenoisedPicture& result) const;

  private:
    vulkan::VulkanContext& context_;
    DenoisePipelines pipelines_;
    LiveHistory history_;
    std::optional<DeviceDenoiser> picture_; // of the size of the last one
    std::uint32_t width_ = 0, height_ = 0;  // which is this
    std::uint32_t surfaceSamples_ = 0;      // of the engine's own surfaces that are there; 0: none or others
};

// By the device where the film is there, else by the processor; so it is where the device fails, as for want of memory.
// Both are the same engine, and must outlive it.
std::unique_ptr<app::PictureDenoiser> makeFilmDenoiser(app::Engine& engine, FilmOnDevice& film, std::uint32_t width,
                                                       std::uint32_t height);

} // namespace rt::gpu
