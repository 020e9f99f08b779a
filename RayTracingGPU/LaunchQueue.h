// The launches that the device has been handed: two at most, so that the next one is recorded while it works at one; it would
// have nothing to do in between.
#pragma once
#include <array>
#include <cstdint>

#include "Common/Vulkan/PipelineCache.h"
#include "Common/Vulkan/VulkanContext.h"
#include "Common/Vulkan/VulkanResources.h"
#include "RayTracingGPU/DeviceFilm.h"
#include "RayTracingGPU/Kernel.h"
#include "Shaders/Records.h"

namespace rt::gpu {

class LaunchQueue {
  public:
    LaunchQueue(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache);

    // Whether begin() may be called with it before another end().
    bool hasRoom(const shared::FilmLaunch& launch) const;
    // Hands over a launch that `film` describes, whose memory must last until the end of it: paths, and what they add to the film.
    // There are no more than `maxInvocations`, and they share the work. Throws DeviceLostError or RenderError; then nothing has begun.
    // Returns how many samples that are.
    std::uint64_t begin(const Kernel& kernel, DeviceFilm& film, const shared::FilmLaunch& launch,
                        std::uint32_t maxInvocations);

    bool isEmpty() const { return ended_ == begun_; }
    std::uint64_t samplesAhead() const; // of all that have begun and not ended

    struct Ended {
        std::uint64_t samples = 0;   // that were to be taken
        std::uint64_t finished = 0;  // as many, but for drivers that end long loops early: that has been seen
        std::uint64_t scattered = 0; // rays
        std::uint64_t shadow = 0;    // rays
        std::uint64_t nonfinite = 0; // samples that were dropped
        double seconds = 0;          // by the device's clock, if it has one
    };
    // Waits for the oldest, which has ended whether or not this throws DeviceLostError or RenderError.
    Ended end();
    // After a failure: waits for all, as far as the device still answers.
    void drop();

  private:
    struct Launch {
        explicit Launch(vulkan::VulkanContext& context);

        vulkan::Run run;
        vulkan::Buffer counters; // of it, when it has ended
        std::uint64_t samples = 0;
    };
    Launch& numbered(std::uint64_t n) { return launches_[n % launches_.size()]; }
    const Launch& numbered(std::uint64_t n) const { return launches_[n % launches_.size()]; }

    vulkan::VulkanContext& context_;
    FilmPipeline reducer_;
    vulkan::Buffer counters_; // of the launch that the device works at
    vulkan::Buffer radiance_; // likewise
    std::array<Launch, 2> launches_;
    std::uint64_t begun_ = 0; // launches, numbered from 0
    std::uint64_t ended_ = 0;
};

} // namespace rt::gpu
