#include "RayTracingGPU/PixelPass.h"

#include <algorithm>
#include <vector>

#include "Common/Vulkan/StagingRing.h"
#include "RayTracingGPU/Launches.h"
#include "Shaders/Records.h"

namespace rt::gpu {
namespace {

constexpr std::uint64_t kPiecePixels = 1u << 20; // on the device at a time

// Pixels from `first` to `end` of the pass, in launches; the buffer begins with those of the first.
bool runPiece(vulkan::VulkanContext& context, const Kernel& kernel, const PixelPass& pass, const vulkan::Buffer& to,
              std::uint64_t first, std::uint64_t end, LaunchSize& size, const std::atomic<bool>* cancel) {
    const std::uint64_t before = std::uint64_t{pass.width} * pass.firstRow;
    for (std::uint64_t pixel = first; pixel < end;) {
        if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) return false;
        const std::uint64_t fitting = std::max<std::uint64_t>(1, size.suggest() / pass.samples);
        const std::uint64_t count = std::min(end - pixel, fitting);
        shared::PixelLaunch launch{};
        launch.values = to.address() + (pixel - first) * pass.values * sizeof(float);
        launch.firstPixel = static_cast<std::uint32_t>(before + pixel);
        launch.pixels = static_cast<std::uint32_t>(count);
        launch.samples = pass.samples;
        launch.looksThrough = pass.looksThrough ? 1 : 0;
        const double seconds = context.runTimed([&](VkCommandBuffer commands) {
            kernel.launch(commands, launch, launch.pixels);
            vulkan::barrier(commands, kernel.access(), context.bufferUses());
        });
        size.measured(count * pass.samples, seconds);
        pixel += count;
    }
    return true;
}

} // namespace

bool runPixelPass(vulkan::VulkanContext& context, const Kernel& kernel, const PixelPass& pass, const vulkan::Buffer& to,
                  const std::atomic<bool>& cancel) {
    LaunchSize size(context.info().isSoftware(), pass.maxDepth);
    return runPiece(context, kernel, pass, to, 0, std::uint64_t{pass.width} * pass.rows, size, &cancel);
}

void runPixelPass(vulkan::VulkanContext& context, const Kernel& kernel, const PixelPass& pass,
                  const std::function<void(std::span<const float> values, std::size_t firstPixel)>& take) {
    const std::uint64_t pixels = std::uint64_t{pass.width} * pass.rows;
    const std::uint64_t piece = std::min(pixels, kPiecePixels);
    std::vector<float> values(piece * pass.values);
    const vulkan::Buffer buffer(context.memory(), values.size() * sizeof(float), 0, vulkan::Memory::Device,
                                "values of pixels");
    LaunchSize size(context.info().isSoftware(), pass.maxDepth);
    for (std::uint64_t first = 0; first < pixels; first += piece) {
        const std::uint64_t end = std::min(pixels, first + piece);
        runPiece(context, kernel, pass, buffer, first, end, size, nullptr);
        const std::span<float> done = std::span(values).first((end - first) * pass.values);
        vulkan::download(context, buffer, std::as_writable_bytes(done));
        take(done, first);
    }
}

} // namespace rt::gpu
