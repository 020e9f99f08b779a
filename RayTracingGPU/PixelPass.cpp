#include "RayTracingGPU/PixelPass.h"

#include <algorithm>
#include <vector>

#include "Common/Vulkan/StagingRing.h"
#include "RayTracingGPU/Launches.h"
#include "Shaders/Records.h"

namespace rt::gpu {
namespace {

constexpr std::uint64_t kPiecePixels = 1u << 20; // on the device at a time

// From the image's first pixel to the first one of one of its runs.
std::uint64_t pixelsBefore(const PixelPass& pass, std::uint64_t run) {
    const shared::uvec2 first = shared::firstPixelOfRun(static_cast<std::uint32_t>(run), pass.width, pass.run);
    return std::uint64_t{first.y} * pass.width + first.x;
}

// Runs of the image from `first` to `end`, in launches; the buffer begins with their first pixel.
bool runPiece(vulkan::VulkanContext& context, const Kernel& kernel, const PixelPass& pass, const vulkan::Buffer& to,
              std::uint64_t first, std::uint64_t end, LaunchSize& size, const std::atomic<bool>* cancel) {
    const std::uint64_t samples = std::uint64_t{pass.samples} * pass.run; // of an invocation
    const std::uint64_t before = pixelsBefore(pass, first);
    for (std::uint64_t run = first; run < end;) {
        if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) return false;
        const std::uint64_t count = std::min(end - run, std::max<std::uint64_t>(1, size.suggest() / samples));
        shared::PixelLaunch launch{};
        launch.values = to.address() + (pixelsBefore(pass, run) - before) * pass.values * sizeof(float);
        launch.firstRun = static_cast<std::uint32_t>(run);
        launch.runs = static_cast<std::uint32_t>(count);
        launch.samples = pass.samples;
        launch.looksThrough = pass.looksThrough ? 1 : 0;
        launch.isAdaptive = pass.isAdaptive ? 1 : 0;
        const double seconds = context.runTimed([&](VkCommandBuffer commands) {
            kernel.launch(commands, launch, launch.runs);
            vulkan::barrier(commands, kernel.access(), context.bufferUses());
        });
        size.measured(count * samples, seconds);
        run += count;
    }
    return true;
}

// The runs of a pass.
struct Runs {
    std::uint64_t first, end;
    explicit Runs(const PixelPass& pass)
        : first(std::uint64_t{shared::runsOfRow(pass.width, pass.run)} * pass.firstRow),
          end(first + std::uint64_t{shared::runsOfRow(pass.width, pass.run)} * pass.rows) {}
};

} // namespace

bool runPixelPass(vulkan::VulkanContext& context, const Kernel& kernel, const PixelPass& pass, const vulkan::Buffer& to,
                  const std::atomic<bool>& cancel) {
    LaunchSize size(context.info().isSoftware(), pass.maxDepth);
    const Runs runs(pass);
    return runPiece(context, kernel, pass, to, runs.first, runs.end, size, &cancel);
}

void runPixelPass(vulkan::VulkanContext& context, const Kernel& kernel, const PixelPass& pass,
                  const std::function<void(std::span<const float> values, std::size_t firstPixel)>& take) {
    const Runs runs(pass);
    const std::uint64_t piece = kPiecePixels / pass.run;
    std::vector<float> values(std::min(std::uint64_t{pass.width} * pass.rows, kPiecePixels) * pass.values);
    const vulkan::Buffer buffer(context.memory(), values.size() * sizeof(float), 0, vulkan::Memory::Device,
                                "values of pixels");
    LaunchSize size(context.info().isSoftware(), pass.maxDepth);
    const std::uint64_t before = pixelsBefore(pass, runs.first);
    for (std::uint64_t run = runs.first; run < runs.end; run += piece) {
        const std::uint64_t end = std::min(runs.end, run + piece);
        runPiece(context, kernel, pass, buffer, run, end, size, nullptr);
        const std::uint64_t first = pixelsBefore(pass, run);
        const std::span<float> done = std::span(values).first((pixelsBefore(pass, end) - first) * pass.values);
        vulkan::download(context, buffer, std::as_writable_bytes(done));
        take(done, first - before);
    }
}

} // namespace rt::gpu
