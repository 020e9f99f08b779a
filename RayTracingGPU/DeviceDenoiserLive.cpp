// Live quality of DeviceDenoiser.
#include <algorithm>
#include <cstddef>
#include <utility>

#include "Common/Shared/Denoise/DenoiseLive.h"
#include "Common/Vulkan/Barrier.h"
#include "RayTracingGPU/DeviceDenoiser.h"
#include "RayTracingGPU/LiveHistory.h"

namespace rt::gpu {
namespace {

constexpr std::size_t kPlanePixelBytes = 4 * sizeof(float);

} // namespace

// Both halves with their history, in memory that no level of live quality writes before they are read.
VkDeviceAddress DeviceDenoiser::mergedAddress() const {
    return radiance_.address();
}

void DeviceDenoiser::recordHistory(VkCommandBuffer commands, const HistoryStep& step) {
    shared::HistoryLaunch launch{};
    launch.halves = halves_.address();
    launch.surfaces = surfaces_.address();
    launch.views = step.views.address();
    launch.next = step.next.planes.address();
    launch.found = filtered_.address() + 4 * pixels_ * kPlanePixelBytes; // behind what the levels have there
    launch.differences = values_.address();
    launch.means = means_.address();
    launch.merged = mergedAddress();
    launch.width = width_;
    launch.height = height_;
    launch.samples = step.samples;
    launch.isOne = step.firstHalfOfOne ? 1 : 0;
    launch.firstHalfOfOne = step.firstHalfOfOne.value_or(0);
    const shared::HistoryCameras views{step.next.camera, step.last ? step.last->camera : step.next.camera};
    vkCmdUpdateBuffer(commands, step.views.get(), 0, sizeof views, &views);
    vulkan::barrier(commands, vulkan::kTransferWrite, vulkan::kComputeRead);
    const auto run = [&](DenoisePass pass, const auto& of) {
        pipelines_.run(commands, pass, of, groups());
        vulkan::barrier(commands, vulkan::kComputeWrite, context_.bufferUses());
    };
    if (step.last) {
        launch.last = step.last->planes.address();
        launch.lastWidth = step.last->width;
        launch.lastHeight = step.last->height;
        run(DenoisePass::History, launch);
        shared::DenoiseLaunch means = makeLaunch();
        means.use = shared::kMeansOfHistory;
        run(DenoisePass::Mean, means);
    }
    run(DenoisePass::HistoryMerge, launch);
}

// Levels go to and fro between the memory of what candidates make of halves and that of halves.
void DeviceDenoiser::recordLive(VkCommandBuffer commands, VkDeviceAddress halves) {
    shared::LiveLaunch launch{};
    launch.halves = halves;
    launch.surfaces = surfaces_.address();
    launch.features = features_.address();
    launch.values = values_.address();
    launch.radiance = filtered_.address();
    launch.tones = filtered_.address() + 2 * pixels_ * kPlanePixelBytes;
    launch.newRadiance = radiance_.address();
    launch.newTones = guides_.address();
    launch.width = width_;
    launch.height = height_;
    shared::DenoiseLaunch means = makeLaunch();
    means.guides = launch.tones;
    means.use = shared::kMeansToTones;
    const auto run = [&](DenoisePass pass, const auto& of) {
        pipelines_.run(commands, pass, of, groups());
        vulkan::barrier(commands, vulkan::kComputeWrite, context_.bufferUses());
    };
    run(DenoisePass::LivePrepare, launch);
    launch.halves = halves_.address(); // where the picture is to be
    run(DenoisePass::Mean, means);
    for (launch.level = 0; launch.level < shared::kLiveLevels; ++launch.level) {
        run(DenoisePass::Live, launch);
        std::swap(launch.radiance, launch.newRadiance);
        std::swap(launch.tones, launch.newTones);
    }
}

void DeviceDenoiser::runLive(const HistoryStep* history) {
    passSeconds_ = {};
    passSeconds_[static_cast<std::size_t>(DenoisePass::Live)] = context_.runTimed([&](VkCommandBuffer commands) {
        if (history) recordHistory(commands, *history);
        recordLive(commands, history ? mergedAddress() : halves_.address());
    });
}

void DeviceDenoiser::remember(const HistoryStep& history) {
    passSeconds_[static_cast<std::size_t>(DenoisePass::HistoryMerge)] =
        context_.runTimed([&](VkCommandBuffer commands) { recordHistory(commands, history); });
}

image::Image DeviceDenoiser::readLive() const {
    return read(halves_, 3, 0);
}

} // namespace rt::gpu
