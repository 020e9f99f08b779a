#include "RayTracingGPU/LaunchQueue.h"

#include <algorithm>
#include <span>

#include "Common/Core/Error.h"

namespace rt::gpu {
namespace {

using vulkan::Memory;

constexpr VkDeviceSize kCounterBytes = VkDeviceSize{shared::kCounterLines} * shared::kCounters * sizeof(std::uint32_t);

VkDeviceSize radianceBytes(const shared::FilmLaunch& launch) {
    return VkDeviceSize{launch.sampleCount} * sizeof(shared::vec3);
}

VkDeviceSize sharedBytes(const shared::FilmLaunch& launch, bool isShared) {
    return isShared ? VkDeviceSize{launch.sampleCount} * shared::kSharedPathBytes : 0;
}

VkDeviceSize plannedBytes(const shared::FilmLaunch& launch) {
    const bool isPlanned = (launch.flags & shared::kIsPlanned) != 0;
    return isPlanned ? VkDeviceSize{launch.sampleCount} * sizeof(shared::PlannedSample) : 0;
}

VkDeviceSize progressBytes(std::uint64_t invocations) {
    return kCounterBytes + invocations * sizeof(shared::UnfinishedPath);
}

// Where it is too small, without its contents; larger by a factor then, if there is memory, since launches grow until
// they are as long as they may be.
void reserve(vulkan::VulkanContext& context, vulkan::Buffer& buffer, VkDeviceSize bytes, VkDeviceSize maximum) {
    constexpr VkDeviceSize kGrowth = 4;
    if (buffer.bytes() >= bytes) return;
    buffer = {}; // its memory may be needed for the next one
    const auto make = [&](VkDeviceSize size) {
        buffer = vulkan::Buffer(context.memory(), size, 0, Memory::Device, "a launch");
    };
    const VkDeviceSize ample = std::max(bytes, std::min(kGrowth * bytes, maximum));
    try {
        make(ample);
    } catch (const RenderError&) {
        if (ample == bytes) throw;
        make(bytes);
    }
}

} // namespace

LaunchQueue::Launch::Launch(vulkan::VulkanContext& context)
    : run(context),
      progress(context.memory(), kCounterBytes, 0, Memory::Device, "a launch"),
      hostCounters(context.memory(), kCounterBytes, 0, Memory::ReadBack, "counters") {}

LaunchQueue::LaunchQueue(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache, const LaunchLimits& limits)
    : context_(context),
      reducer_(context, cache, Shader::FilmReduce, sizeof(shared::ReduceLaunch)),
      lister_(context, cache, Shader::SampleList, sizeof(shared::ListLaunch)),
      limits_(limits),
      launches_{Launch(context), Launch(context)} {}

void LaunchQueue::prepare(std::uint64_t samples) {
    const VkDeviceSize radiance = std::min(samples, limits_.samples) * sizeof(shared::vec3);
    const VkDeviceSize progress = progressBytes(std::min<std::uint64_t>(samples, limits_.invocations));
    try {
        for (Launch& launch : launches_) {
            reserve(context_, launch.radiance, radiance, radiance);
            reserve(context_, launch.progress, progress, progress);
        }
    } catch (const RenderError&) { // smaller launches may do
    }
}

// No fewer than there are paths to go on with.
std::uint32_t LaunchQueue::invocationsFor(const shared::FilmLaunch& launch) const {
    return std::max(std::min(launch.sampleCount, limits_.invocations), last_ ? invocations_ : 0);
}

// Where its memory does not suffice, there is more when none of it is in use.
bool LaunchQueue::hasRoom(const shared::FilmLaunch& launch, bool isShared) const {
    if (isEmpty()) return true;
    const Launch& next = numbered(begun_);
    return begun_ - ended_ < launches_.size() && radianceBytes(launch) <= next.radiance.bytes() &&
           sharedBytes(launch, isShared) <= next.sharedPaths.bytes() && plannedBytes(launch) <= next.planned.bytes() &&
           progressBytes(invocationsFor(launch)) <= next.progress.bytes();
}

bool LaunchQueue::overlaps(const shared::FilmLaunch& launch) const {
    if (!last_) return false;
    return last_->bandSlots != launch.bandSlots || (launch.firstSlot < last_->firstSlot + last_->bandWidth &&
                                                    last_->firstSlot < launch.firstSlot + launch.bandWidth);
}

std::uint64_t LaunchQueue::begin(const LaunchKernels& kernels, DeviceFilm& film, const shared::FilmLaunch& launch) {
    Launch& next = numbered(begun_);
    const std::uint32_t invocations = invocationsFor(launch);
    reserve(context_, next.radiance, radianceBytes(launch), limits_.samples * sizeof(shared::vec3));
    reserve(context_, next.sharedPaths, sharedBytes(launch, kernels.reuse != nullptr),
            limits_.samples * shared::kSharedPathBytes);
    reserve(context_, next.planned, plannedBytes(launch), limits_.samples * sizeof(shared::PlannedSample));
    reserve(context_, next.progress, progressBytes(invocations), progressBytes(limits_.invocations));
    next.samples = film.samplesOf(launch);
    shared::FilmLaunch samples = launch;
    samples.radiance = next.radiance.address();
    const std::uint64_t added = submit(kernels, film, samples, invocations);
    last_ = samples;
    invocations_ = invocations;
    return added;
}

std::uint64_t LaunchQueue::finish(const LaunchKernels& kernels, DeviceFilm& film) {
    shared::FilmLaunch none = *last_;
    none.slotCount = none.sampleCount = 0;
    numbered(begun_).samples = 0;
    const std::uint64_t added = submit(kernels, film, none, invocations_);
    last_.reset();
    return added;
}

// Records paths, what the samples of the launch before share, and what they add to the film.
std::uint64_t LaunchQueue::submit(const LaunchKernels& kernels, DeviceFilm& film, const shared::FilmLaunch& samples,
                                  std::uint32_t invocations) {
    Launch& next = numbered(begun_);
    const Launch& before = numbered(begun_ + 1); // they take turns
    const shared::PathLaunch tracing{.film = samples,
                                     .planned = next.planned.address(),
                                     .sharedPaths = next.sharedPaths.address(),
                                     .progress = next.progress.address(),
                                     .radianceBefore = before.radiance.address(),
                                     .sharedPathsBefore = before.sharedPaths.address(),
                                     .progressBefore = before.progress.address()};
    const vulkan::Access access = kernels.paths.access();
    next.run.begin([&](VkCommandBuffer commands) {
        vkCmdFillBuffer(commands, next.progress.get(), 0, kCounterBytes, 0);
        if (!last_) vkCmdFillBuffer(commands, before.progress.get(), 0, kCounterBytes, 0);
        vulkan::barrier(commands, vulkan::kTransferWrite, access | vulkan::kComputeRead | vulkan::kComputeWrite);
        if (plannedBytes(samples) != 0) {
            const shared::ListLaunch listing{samples, tracing.planned, tracing.progress};
            lister_.run(commands, listing, samples.slotCount);
            vulkan::barrier(commands, vulkan::kComputeWrite, access | vulkan::kComputeRead);
        }
        kernels.paths.launch(commands, tracing, invocations);
        if (last_ && kernels.reuse != nullptr) {
            vulkan::barrier(commands, access, access);
            shared::PathLaunch sharing = tracing; // whose counters it adds to
            sharing.film = *last_;
            sharing.planned = before.planned.address();
            sharing.sharedPaths = before.sharedPaths.address();
            kernels.reuse->launch(commands, sharing, last_->sampleCount / shared::kReuseGroup);
        }
        vulkan::barrier(commands, access, vulkan::kComputeRead | vulkan::kTransferRead);
        if (last_) reducer_.run(commands, film.reductionOf(*last_), last_->slotCount);
        const VkBufferCopy all{0, 0, kCounterBytes};
        vkCmdCopyBuffer(commands, next.progress.get(), next.hostCounters.get(), 1, &all);
        // The next launch goes on with paths and film, and clears the counters that this one has read.
        const vulkan::Access done = access | vulkan::kComputeWrite | vulkan::kTransferWrite;
        vulkan::barrier(commands, done, context_.bufferUses() | vulkan::kHostRead);
    });
    ++begun_;
    if (!last_) return 0;
    film.advance(*last_);
    return before.samples;
}

void LaunchQueue::forget() {
    last_.reset();
    left_ = 0;
}

std::uint64_t LaunchQueue::samplesAhead() const {
    std::uint64_t samples = 0;
    for (std::uint64_t n = ended_; n < begun_; ++n) samples += numbered(n).samples;
    return samples;
}

LaunchQueue::Ended LaunchQueue::end() {
    Launch& launch = numbered(ended_++);
    Ended ended;
    ended.samples = launch.samples;
    ended.seconds = context_.finishTimed(launch.run);
    const std::span<const std::uint32_t> counters = launch.hostCounters.mapped<const std::uint32_t>();
    for (std::size_t line = 0; line < counters.size(); line += shared::kCounters) {
        ended.edgeRays += counters[line + shared::kCounterEdgeRays];
        ended.scattered += counters[line + shared::kCounterScattered];
        ended.shadow += counters[line + shared::kCounterShadow];
        ended.reuse += counters[line + shared::kCounterReuse];
        ended.nonfinite += counters[line + shared::kCounterNonfinite];
        ended.cutOff += counters[line + shared::kCounterCutOff] * double{shared::kCutOffUnit};
        ended.finished += counters[line + shared::kCounterFinished];
    }
    ended.due = left_ + ended.samples - counters[shared::kCounterLeft];
    left_ = counters[shared::kCounterLeft];
    return ended;
}

void LaunchQueue::drop() {
    for (; ended_ < begun_; ++ended_) {
        try {
            numbered(ended_).run.finish();
        } catch (const RenderError&) { // as the one before
        }
    }
    forget();
}

} // namespace rt::gpu
