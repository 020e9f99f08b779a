// The launches that the device has been handed: two at most, so that the next one is recorded while it works at one; it
// would have nothing to do in between. A launch leaves its last paths to the next one, behind which its samples come to
// the film.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "Common/Shared/Technique/PathReuse.h"
#include "Common/Vulkan/Buffer.h"
#include "Common/Vulkan/PipelineCache.h"
#include "Common/Vulkan/VulkanContext.h"
#include "RayTracingGPU/DeviceFilm.h"
#include "RayTracingGPU/Kernel.h"
#include "Shaders/Records.h"

namespace rt::gpu {

// What launches run.
struct LaunchKernels {
    const Kernel& paths;
    const Kernel* reuse; // null: samples share nothing
};

// Of a launch, at most.
struct LaunchLimits {
    std::uint32_t invocations = 0; // that share its work
    std::uint64_t samples = 0;
};

class LaunchQueue {
  public:
    LaunchQueue(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache, const LaunchLimits& limits);

    // Makes room for launches of a film that has so many samples, as far as there is memory; only when isEmpty().
    // Otherwise they get it when they first are that large: on an H100 that takes 8 ms.
    void prepare(std::uint64_t samples);
    // Whether begin() may be called with it before another end(); with FilmLaunch{}, whether finish() may.
    bool hasRoom(const shared::FilmLaunch& launch, bool isShared) const;
    // Whether it goes on where samples of the launch before are still to come; then finish() comes first.
    bool overlaps(const shared::FilmLaunch& launch) const;
    // Hands over a launch that `film` describes, whose memory must last until the end of the launch behind it. Throws
    // DeviceLostError or RenderError; then nothing has begun. Returns how many samples come to the film behind it:
    // those of the launch before.
    std::uint64_t begin(const LaunchKernels& kernels, DeviceFilm& film, const shared::FilmLaunch& launch);

    // Whether the last launch has left paths, and its samples are still to come.
    bool isUnfinished() const { return last_.has_value(); }
    // Hands over what the last launch has left. Otherwise like begin().
    std::uint64_t finish(const LaunchKernels& kernels, DeviceFilm& film);
    // Its samples are not to come. Only when isEmpty().
    void forget();

    bool isEmpty() const { return ended_ == begun_; }
    std::uint64_t samplesAhead() const; // of all that have begun and not ended

    struct Ended {
        std::uint64_t samples = 0;   // that it began
        std::uint64_t due = 0;       // that were to end in it
        std::uint64_t finished = 0;  // as many, but for drivers that end long loops early: that has been seen
        std::uint64_t edgeRays = 0;  // see EdgeRays.h
        std::uint64_t scattered = 0; // rays
        std::uint64_t shadow = 0;    // rays
        std::uint64_t reuse = 0;     // rays, for samples of the launch before
        std::uint64_t nonfinite = 0; // samples that were dropped
        double cutOff = 0;           // as EngineReport::cutOff
        double seconds = 0;          // by the device's clock, if it has one
    };
    // Waits for the oldest, which has ended whether or not this throws DeviceLostError or RenderError.
    Ended end();
    // After a failure: waits for all, as far as the device still answers, and forgets.
    void drop();

  private:
    struct Launch {
        explicit Launch(vulkan::VulkanContext& context);

        vulkan::Run run;
        vulkan::Buffer progress;     // counters, and paths that are left
        vulkan::Buffer hostCounters; // a copy, when it has ended
        vulkan::Buffer radiance;
        vulkan::Buffer sharedPaths;
        vulkan::Buffer planned; // samples, if there is a plan
        std::uint64_t samples = 0;
    };
    Launch& numbered(std::uint64_t n) { return launches_[n % launches_.size()]; }
    const Launch& numbered(std::uint64_t n) const { return launches_[n % launches_.size()]; }
    std::uint32_t invocationsFor(const shared::FilmLaunch& launch) const;
    std::uint64_t submit(const LaunchKernels& kernels, DeviceFilm& film, const shared::FilmLaunch& samples,
                         std::uint32_t invocations);

    vulkan::VulkanContext& context_;
    FilmPipeline reducer_;
    FilmPipeline lister_; // of a plan's samples
    LaunchLimits limits_;
    std::array<Launch, 2> launches_;
    std::uint64_t begun_ = 0; // launches, numbered from 0
    std::uint64_t ended_ = 0;
    std::optional<shared::FilmLaunch> last_; // that has begun, if it is unfinished
    std::uint32_t invocations_ = 0;          // of it
    std::uint64_t left_ = 0;                 // paths, by the last launch that has ended
};

} // namespace rt::gpu
