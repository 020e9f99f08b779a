#include "RayTracingGPU/LaunchQueue.h"

#include <algorithm>
#include <span>

#include "Common/Core/Error.h"

namespace rt::gpu {
namespace {

using vulkan::Memory;

constexpr VkDeviceSize kCounterBytes = VkDeviceSize{shared::kCounterLines} * shared::kCounters * sizeof(std::uint32_t);

VkDeviceSize radianceBytes(const shared::FilmLaunch& launch) {
    return VkDeviceSize{shared::launchSamples(launch)} * sizeof(shared::vec3);
}

} // namespace

LaunchQueue::Launch::Launch(vulkan::VulkanContext& context)
    : run(context), counters(context, kCounterBytes, 0, Memory::ReadBack, "counters") {}

LaunchQueue::LaunchQueue(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache)
    : context_(context),
      reducer_(context, cache, Shader::FilmReduce, sizeof(shared::FilmLaunch)),
      counters_(context, kCounterBytes, 0, Memory::Device, "counters"),
      launches_{Launch(context), Launch(context)} {}

bool LaunchQueue::hasRoom(const shared::FilmLaunch& launch) const {
    return isEmpty() || (begun_ - ended_ < launches_.size() && radianceBytes(launch) <= radiance_.bytes());
}

std::uint64_t LaunchQueue::begin(const Kernel& kernel, DeviceFilm& film, const shared::FilmLaunch& launch,
                                 std::uint32_t maxInvocations) {
    if (radiance_.bytes() < radianceBytes(launch)) {
        const VkDeviceSize bytes = radianceBytes(launch) / 4 * 5; // the next one is rarely just as large
        radiance_ = {};
        radiance_ = vulkan::Buffer(context_, bytes, 0, Memory::Device, "a launch");
    }
    shared::FilmLaunch push = launch;
    push.radiance = radiance_.address();
    push.counters = counters_.address();
    Launch& next = numbered(begun_);
    next.run.begin([&](VkCommandBuffer commands) {
        vkCmdFillBuffer(commands, counters_.get(), 0, VK_WHOLE_SIZE, 0);
        vulkan::barrier(commands);
        kernel.launch(commands, push, std::min(shared::launchSamples(push), maxInvocations));
        vulkan::barrier(commands);
        reducer_.run(commands, push, push.slotCount);
        const VkBufferCopy all{0, 0, kCounterBytes};
        vkCmdCopyBuffer(commands, counters_.get(), next.counters.get(), 1, &all);
        vulkan::barrier(commands);
    });
    ++begun_;
    next.samples = film.advance(push);
    return next.samples;
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
    const std::span<const std::uint32_t> counters = launch.counters.mapped<const std::uint32_t>();
    for (std::size_t line = 0; line < counters.size(); line += shared::kCounters) {
        ended.scattered += counters[line + shared::kCounterScattered];
        ended.shadow += counters[line + shared::kCounterShadow];
        ended.nonfinite += counters[line + shared::kCounterNonfinite];
        ended.finished += counters[line + shared::kCounterFinished];
    }
    return ended;
}

void LaunchQueue::drop() {
    for (; ended_ < begun_; ++ended_) {
        try {
            numbered(ended_).run.finish();
        } catch (const RenderError&) { // as the one before
        }
    }
}

} // namespace rt::gpu
